// A control for every setting of the table, made from what the table says of it.

import { h } from "./elements.js";

/** Sections that are open in the beginning. */
const OPEN = new Set(["Light", "Colour and tone"]);
/** A slider of very wide numbers shows this share of them about the default; the field takes all. */
const SHARE = 1 / 8;
const WIDE = 20;

/**
 * Builds the controls. `describe` is the table; `hands` has `set(name, text, live)`, which is called with `live` while a slider
 * moves, and `extra` elements by the name of the setting that they stand below.
 */
export class Controls {
  #controls = new Map();

  constructor(describe, hands) {
    this.element = h("div", { class: "controls" });
    const sections = new Map();
    for (const setting of describe) {
      if (!sections.has(setting.section)) sections.set(setting.section, section(setting.section, this.element));
      const control = new Control(setting, hands);
      this.#controls.set(setting.name, control);
      sections.get(setting.section).append(control.element);
      if (hands.extra?.[setting.name]) sections.get(setting.section).append(hands.extra[setting.name]);
    }
  }

  /** Shows what a draft says. */
  show(draft) {
    for (const [name, control] of this.#controls) control.show(draft.text(name), name in draft.edits, draft.base[name]);
  }

  /** Shows a fault where it belongs: below the control whose name it begins with. Whether there is one. */
  fault(words) {
    let found = false;
    for (const [name, control] of this.#controls) {
      const is = words?.startsWith(`\`${name}\``) ?? false;
      control.fault(is ? words.slice(name.length + 3).trim() : "");
      if (is) {
        control.element.closest("details").open = true;
        control.element.scrollIntoView({ block: "nearest" });
      }
      found ||= is;
    }
    return found;
  }
}

function section(title, into) {
  const body = h("div", { class: "section" });
  into.append(h("details", { open: OPEN.has(title) }, h("summary", {}, title), body));
  return body;
}

/** `highlights-tone` to `Highlights tone`. */
export const title = (name) => (name[0].toUpperCase() + name.slice(1)).replaceAll("-", " ");

class Control {
  #setting;
  #hands;
  #show;
  #reset;
  #note;
  #fault;

  constructor(setting, hands) {
    this.#setting = setting;
    this.#hands = hands;
    const { name, help } = setting;
    const id = `setting-${name}`;
    this.#reset = h("button", { class: "reset", title: `Back to ${show(setting.default)}`, "aria-label": `Reset ${title(name)}`, onclick: () => hands.set(name, null) }, "↺");
    this.#note = h("span", { class: "origin" });
    this.#fault = h("p", { class: "notice", role: "status", hidden: true });
    const make = { number: numberField, "whole number": numberField, switch: switchField, word: wordField }[setting.type] ?? (setting.range ? amountField : textField);
    const { parts, show: shows } = make(setting, id, (text, live) => hands.set(name, text, live));
    this.#show = shows;
    const inline = parts.length === 1;
    this.element = h("div", { class: `control ${inline ? "inline" : ""}`, "data-setting": name },
      h("label", { for: id, title: help }, title(name), this.#note),
      parts[0],
      this.#reset,
      parts[1],
      this.#fault,
    );
  }

  show(text, isEdited, base) {
    this.#show(text);
    this.element.classList.toggle("edited", isEdited);
    this.#reset.disabled = !isEdited;
    const from = base?.from ?? "default";
    this.#reset.title = `Back to ${show(base?.text)}`;
    this.#note.textContent = from === "default" || isEdited ? "" : "•";
    this.#note.title = `from ${from}`;
  }

  fault(words) {
    this.#fault.textContent = words;
    this.#fault.hidden = !words;
    this.#fault.dataset.kind = "fault";
  }
}

const show = (text) => (text === "" ? "nothing" : String(text));

/** A number: a field, and a slider below. */
function numberField(setting, id, set) {
  const { range, unit, default: usual } = setting;
  const whole = setting.type === "whole number";
  let [least, most] = range;
  if (!whole && most - least > WIDE) {
    const reach = (most - least) * SHARE;
    [least, most] = [Math.max(least, usual - reach), Math.min(most, usual + reach)];
  }
  const step = whole ? 1 : most - least > 5 ? 0.05 : most - least > 1 ? 0.02 : 0.01;
  const slider = h("input", { type: "range", min: least, max: most, step, "aria-label": title(setting.name) });
  const input = h("input", { id, type: "number", min: range[0], max: range[1], step, title: unit ? `${unit}, ${range[0]} to ${range[1]}` : `${range[0]} to ${range[1]}` });
  slider.addEventListener("input", () => { input.value = slider.value; set(String(Number(slider.value)), true); });
  slider.addEventListener("change", () => set(String(Number(slider.value))));
  slider.addEventListener("dblclick", () => set(null));
  input.addEventListener("change", () => set(input.value === "" ? null : String(Number(input.value))));
  return {
    parts: [input, slider],
    show(text) {
      if (document.activeElement !== input) input.value = text;
      slider.value = text;
      fillTrack(slider, usual);
    },
  };
}

/** Shows on the track how far a slider is from where it usually stands. */
function fillTrack(slider, usual) {
  const share = (v) => (100 * (v - slider.min)) / (slider.max - slider.min);
  const ends = [share(Number(slider.value)), share(usual)].sort((a, b) => a - b);
  slider.style.setProperty("--from", `${ends[0]}%`);
  slider.style.setProperty("--to", `${ends[1]}%`);
}

/** A word or a number from 0 on: a field that takes both, and a slider for the number. */
function amountField(setting, id, set) {
  const [least, most] = setting.range;
  const slider = h("input", { type: "range", min: least, max: most, step: 0.02, "aria-label": title(setting.name) });
  const input = h("input", { id, type: "text", class: "amount", spellcheck: "false", title: setting.allowed });
  slider.addEventListener("input", () => { input.value = slider.value; set(String(Number(slider.value)), true); });
  slider.addEventListener("change", () => set(String(Number(slider.value))));
  slider.addEventListener("dblclick", () => set(null));
  input.addEventListener("change", () => set(input.value.trim() || null));
  return {
    parts: [input, slider],
    show(text) {
      if (document.activeElement !== input) input.value = text;
      const number = Number(text);
      slider.value = Number.isNaN(number) ? (text === "off" ? 0 : 1) : number;
      fillTrack(slider, 1);
    },
  };
}

function switchField(setting, id, set) {
  const input = h("input", { id, type: "checkbox", class: "switch", title: setting.help });
  input.addEventListener("change", () => set(String(input.checked)));
  return { parts: [input], show: (text) => { input.checked = text === "true"; } };
}

function wordField(setting, id, set) {
  const options = setting.words.map(({ word, help }) => h("option", { value: word, title: help }, word));
  const input = h("select", { id, title: setting.help }, options);
  input.addEventListener("change", () => set(input.value));
  return {
    parts: [input],
    show(text) {
      input.value = text;
      input.title = setting.words.find(({ word }) => word === text)?.help || setting.help;
    },
  };
}

function textField(setting, id, set) {
  const list = setting.words?.length ? h("datalist", { id: `${id}-words` }, setting.words.map(({ word }) => h("option", { value: word }))) : null;
  const input = h("input", { id, type: "text", spellcheck: "false", placeholder: show(setting.default), title: setting.allowed, list: null });
  if (list) input.setAttribute("list", list.id);
  input.addEventListener("change", () => set(input.value.trim() || null));
  const part = list ? h("span", { class: "with-list" }, input, list) : input;
  return { parts: [part], show: (text) => { if (document.activeElement !== input) input.value = text; } };
}
