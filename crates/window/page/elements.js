// Small helpers to build the page. Texts are always text: nothing that comes from a file is ever read as HTML.

/** An element: `h("button", { class: "a", onclick: f }, "text", child)`. `null` and `false` are left out. */
export function h(tag, attributes = {}, ...children) {
  return filled(document.createElement(tag), attributes, children);
}

const SVG = "http://www.w3.org/2000/svg";

/** An element of SVG. */
export function svg(tag, attributes = {}, ...children) {
  return filled(document.createElementNS(SVG, tag), attributes, children);
}

function filled(element, attributes, children) {
  for (const [name, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (name.startsWith("on")) element.addEventListener(name.slice(2), value);
    else if (name in element && typeof value !== "string" && !(element instanceof SVGElement)) element[name] = value;
    else element.setAttribute(name, value === true ? "" : value);
  }
  element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
  return element;
}

/** A place for what went wrong, right where it happened. Empty, it takes no room. */
export class Notice {
  constructor() {
    this.element = h("p", { class: "notice", role: "status", hidden: true });
  }

  /** Shows an error, or takes it away. */
  fault(error) {
    if (error?.name === "AbortError") return;
    this.#show(error ? error.message : "", "fault");
  }

  /** Shows words. */
  say(words) {
    this.#show(words, "said");
  }

  clear() {
    this.#show("", "");
  }

  #show(words, kind) {
    this.element.textContent = words;
    this.element.hidden = !words;
    this.element.dataset.kind = kind;
  }
}

/** Puts children in place of what was there. */
export function fill(element, ...children) {
  element.replaceChildren(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
}

/** The last part of a file's name. */
export const baseName = (file) => shown(file.slice(file.lastIndexOf("/") + 1));

/** A name as people are shown it: bytes that are no text, controls, and what turns the direction of writing are written out. */
export function shown(name) {
  return name
    .replace(/\0([0-9a-f]{2})/g, "\\x$1")
    .replace(/[\u0000-\u001f\u007f-\u009f\u061c\u200e\u200f\u2028-\u202e\u2066-\u2069]/g, (c) => `\\u{${c.codePointAt(0).toString(16)}}`);
}

/** Calls `work` with the newest value, one call at a time: what comes meanwhile waits, and only the newest of it. */
export function newestOnly(work) {
  let busy = false;
  let waiting = null;
  return async function next(value) {
    if (busy) {
      waiting = { value };
      return;
    }
    busy = true;
    try {
      await work(value);
    } finally {
      busy = false;
      if (waiting) {
        const { value: newest } = waiting;
        waiting = null;
        next(newest);
      }
    }
  };
}

/** Calls `work` when nothing was asked for a while. */
export function later(milliseconds, work) {
  let timer = 0;
  return (...values) => {
    clearTimeout(timer);
    timer = setTimeout(() => work(...values), milliseconds);
  };
}

/** Waits until what was changed on the page is on the screen: the second frame begins when the first is there. A page that is
 * not shown waits for nothing. */
export function painted() {
  if (document.hidden) return Promise.resolve();
  return new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)));
}

/** Whether a key goes to a field that takes it. */
export function isTyping(event) {
  return event.target.closest?.("input:not([type=range]):not([type=checkbox]), textarea, select") !== null;
}

/** A labelled field. */
export function field(label, control, help) {
  return h("label", { class: "field", title: help }, h("span", {}, label), control);
}

/** Seconds as people say them. */
export function duration(seconds) {
  if (seconds === null || seconds === undefined) return "";
  const whole = Math.round(seconds);
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60];
  if (hours) return `${hours} h ${minutes} min`;
  if (minutes) return `${minutes} min ${whole % 60} s`;
  return `${whole} s`;
}
