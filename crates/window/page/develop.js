// Developing one photograph: the picture, the controls, and what the picture tells.

import { address, post } from "./server.js";
import { baseName, fill, h, isTyping, newestOnly, Notice, painted, shown } from "./elements.js";
import { Controls } from "./controls.js";
import { ExportPanel } from "./export.js";
import { Histogram } from "./histogram.js";
import { Picture } from "./picture.js";
import { Readout } from "./readout.js";
import { Tools } from "./tools.js";
import { clipboard, draft as draftOf, hasDraft, unsaved } from "./edits.js";
import { files } from "./files.js";

let root, go, picture, tools, controls, histogram, readout, exports, table;
let draft = null;
let about = null;
const notice = new Notice();
const saved = new Notice();
const parts = {};

/** Settings that say where the picture lies in the frame: what is before the edits lies there, too. */
const geometry = () => table.filter((one) => one.section === "Geometry").map((one) => one.name);

const asked = () => tools.asked({ file: files.current, edits: draft?.edits ?? unsaved(files.current) });
const askedBefore = () => {
  const names = new Set(geometry());
  const now = asked();
  return { ...now, edits: Object.fromEntries(Object.entries(now.edits ?? {}).filter(([name]) => names.has(name))) };
};

export async function build(element, routes, described) {
  root = element;
  go = routes;
  table = described;
  picture = new Picture(asked, askedBefore);
  tools = new Tools(picture, {
    draft: () => draft,
    set: (changes) => { draft.set(changes); draft.commit(); },
    fault,
  });
  histogram = new Histogram();
  readout = new Readout(picture, () => (draft && !tools.holdsPicture ? { file: draft.file, edits: draft.edits } : null));
  exports = new ExportPanel(() => draft);
  parts.light = h("span", { class: "told" });
  const { pick, crop, lines } = tools.buttons;
  controls = new Controls(table, {
    set,
    extra: {
      "white-balance": h("div", { class: "extra" }, pick, ...["as-shot", "daylight", "auto"].map((text) => h("button", { onclick: () => set("white-balance", text) }, text)), parts.light),
      crop: h("div", { class: "extra" }, crop, lines),
    },
  });
  layOut();
  picture.addEventListener("rendered", ({ detail }) => told(detail));
  picture.addEventListener("fault", ({ detail }) => fault(detail));
  picture.addEventListener("view", () => { parts.zoom.textContent = picture.isFitted ? "Fit" : `${Math.round(picture.zoom * devicePixelRatio * 100)} %`; });
  document.addEventListener("keydown", key);
  document.addEventListener("keyup", (event) => { if (event.key === "b") picture.hold(false); });
}

function layOut() {
  const button = (text, title, act, more = {}) => h("button", { title, onclick: act, ...more }, text);
  parts.save = button("Save", "Write the edits into the sidecar (Ctrl+S)", () => save(false), { class: "first" });
  parts.over = button("Save over it", "Save these edits in place of what somebody else wrote", () => save(true), { hidden: true });
  parts.load = button("Load theirs", "Take what somebody else wrote, and let these edits go", reload, { hidden: true });
  parts.undo = button("↶", "Undo (Ctrl+Z)", () => draft?.undo(), { "aria-label": "Undo" });
  parts.redo = button("↷", "Redo (Ctrl+Shift+Z)", () => draft?.redo(), { "aria-label": "Redo" });
  parts.name = h("span", { class: "file-name" });
  parts.facts = h("span", { class: "file-facts" });
  parts.zoom = button("Fit", "Fit (F), or pixel for pixel (Z)", () => (picture.isFitted ? picture.full() : picture.fit()), { class: "zoom" });
  parts.split = button("Before | after", "Before at the left, after at the right (Y); hold B to see before alone", split, { "aria-pressed": "false" });
  parts.strip = h("div", { class: "strip", "aria-label": "Photographs", role: "group" });
  parts.notes = h("ul", { class: "notes" });
  parts.empty = h("p", { class: "empty", hidden: true }, "Choose a photograph: double-click it in the contact sheet, or press Enter there.");
  fill(root,
    h("div", { class: "desk" },
      h("div", { class: "middle" },
        h("div", { class: "tools" }, parts.name, parts.facts, h("span", { class: "space" }), parts.split, parts.zoom, button("Export …", "Write the picture (E)", () => draft && exports.open(draft))),
        notice.element,
        h("div", { class: "stage-frame" }, picture.element, tools.place, exports.element, parts.empty),
        parts.strip),
      h("aside", { class: "side", "aria-label": "Settings" },
        histogram.element,
        readout.element,
        h("div", { class: "buttons" }, parts.undo, parts.redo,
          button("Copy", "Copy the edits, but for the geometry, to paste them onto others in the contact sheet", copy),
          button("Reset", "Take all edits away", resetAll), h("span", { class: "space" }), parts.over, parts.load, parts.save),
        saved.element,
        controls.element,
        parts.notes)));
}

/** Shows a file. */
export async function show(file) {
  parts.empty.hidden = Boolean(file ?? draft);
  if (!file) return go.place("develop", draft?.file);
  tools.end();
  if (draft?.file === file) {
    picture.update();
    return strip();
  }
  draft?.removeEventListener("change", changed);
  draft?.removeEventListener("commit", committed);
  draft = null;
  delete root.dataset.file;
  notice.clear();
  saved.clear();
  exports.close();
  picture.reset();
  histogram.show(null);
  parts.light.textContent = parts.facts.textContent = "";
  fill(parts.notes);
  files.current = file;
  parts.name.textContent = baseName(file);
  parts.name.title = shown(file.slice(file.indexOf("/") + 1));
  parts.empty.hidden = true;
  strip(false);
  // A coarse picture is on its way before the page knows the edits: the server does.
  const first = picture.update(true);
  try {
    const loaded = await draftOf(file);
    if (files.current !== file) return;
    draft = loaded;
    draft.addEventListener("change", changed);
    draft.addEventListener("commit", committed);
    controls.show(draft);
    committed();
    root.dataset.file = file;
    await first;
    // The coarse one is to be on the screen before the processor is busy with the next.
    await painted();
    if (files.current !== file) return;
    picture.update();
  } catch (error) {
    fault(error);
  }
  strip();
  facts(file);
}

async function facts(file) {
  const known = files.facts.get(file) ?? (await post("facts", { files: [file] }).catch(() => []))[0];
  if (!known || files.current !== file) return;
  files.facts.set(file, known);
  const { camera, lens, focal_length: focal, f_number: f, seconds, iso } = known;
  const time = seconds && (seconds < 0.4 ? `1/${Math.round(1 / seconds)} s` : `${seconds} s`);
  parts.facts.textContent = [camera, lens, focal && `${focal} mm`, f && `f/${f}`, time, iso && `ISO ${iso}`].filter(Boolean).join(" · ");
  parts.facts.title = parts.facts.textContent;
}

/** The photographs before and after this one; only their places while something else is wanted first. */
function strip(withPictures = true) {
  const all = files.shown.length ? files.shown : files.all;
  const at = all.findIndex((one) => one.file === files.current);
  const near = at < 0 ? [] : all.slice(Math.max(0, at - 8), at + 9);
  fill(parts.strip, near.map(({ file, modified }) =>
    h("button", { class: `small ${file === files.current ? "now" : ""} ${hasDraft(file) ? "draft" : ""}`, title: baseName(file), "aria-label": baseName(file), "aria-current": file === files.current ? "true" : null, onclick: () => go.develop(file) },
      h("img", { src: withPictures ? address("small", { file, v: modified }) : null, alt: "", decoding: "async", draggable: false, onerror: (e) => { e.target.dataset.broken = ""; } }))));
  parts.strip.hidden = near.length < 2;
  parts.strip.querySelector(".now")?.scrollIntoView({ block: "nearest", inline: "center" });
}

function set(name, text, live = false) {
  if (!draft) return;
  picture.mayBeNoisy = !/noise|pixels/.test(name);
  draft.set({ [name]: text });
  if (!live) draft.commit();
}

const rendering = newestOnly(() => picture.update(true));

function changed() {
  controls.show(draft);
  marks();
  rendering();
}

function committed() {
  marks();
  controls.show(draft);
}

function marks() {
  parts.undo.disabled = !draft.canUndo;
  parts.redo.disabled = !draft.canRedo;
  parts.save.disabled = !draft.isDirty;
  parts.save.textContent = draft.isDirty ? "Save" : "Saved";
}

function told(now) {
  about = now;
  notice.clear();
  controls.fault("");
  histogram.show(about.tally);
  parts.light.textContent = about.kelvin ? `${Math.round(about.kelvin)} K, tint ${about.tint > 0 ? "+" : ""}${about.tint.toFixed(0)}` : "";
  fill(parts.notes, about.notes.map((note) => h("li", {}, note)));
}

function fault(error) {
  if (error.status === 409) return;
  if (!controls.fault(error.message)) notice.fault(error);
}

async function save(anyway) {
  if (!draft || (!draft.isDirty && !anyway)) return;
  try {
    await draft.save(anyway);
    saved.say("Saved in the sidecar.");
    setTimeout(() => saved.clear(), 2500);
    parts.over.hidden = parts.load.hidden = true;
    files.again([draft.file]);
    strip();
  } catch (error) {
    saved.fault(error);
    parts.over.hidden = parts.load.hidden = error.status !== 409;
  }
}

async function reload() {
  await draft.load();
  parts.over.hidden = parts.load.hidden = true;
  saved.clear();
  changed();
  committed();
}

function copy() {
  if (!draft) return;
  const kept = new Set([...geometry(), "set-tag"]);
  const names = Object.keys(draft.edits).filter((name) => !kept.has(name));
  Object.assign(clipboard, { from: baseName(draft.file), names, edits: Object.fromEntries(names.map((name) => [name, draft.edits[name]])) });
  saved.say(names.length ? `Copied: ${names.join(", ")}. Choose photographs in the contact sheet and paste.` : "There are no edits to copy.");
}

function resetAll() {
  if (!draft) return;
  draft.set(Object.fromEntries(Object.keys(draft.edits).filter((name) => name !== "set-tag").map((name) => [name, null])));
  draft.commit();
}

function split() {
  picture.split(!picture.isSplit);
  parts.split.setAttribute("aria-pressed", String(picture.isSplit));
}

function next(by) {
  const all = files.shown.length ? files.shown : files.all;
  const at = all.findIndex((one) => one.file === files.current);
  const file = all[at + by]?.file;
  if (file) go.develop(file);
}

function key(event) {
  if (root.hidden || !draft) return;
  if (tools.key(event)) return event.preventDefault();
  const command = event.ctrlKey || event.metaKey;
  if (command && event.key === "s") save(false);
  else if (command && event.key.toLowerCase() === "z") event.shiftKey ? draft.redo() : draft.undo();
  else if (command && event.key === "y") draft.redo();
  else if (command || event.altKey || isTyping(event)) return;
  else if (tools.holdsPicture) return;
  else if (event.key === "Escape") go.sheet();
  else if (event.key === "b") picture.hold(true);
  else if (event.key === "y") split();
  else if (event.key === "e") exports.open(draft);
  else if (event.key === "f") picture.fit();
  else if (event.key === "z") picture.isFitted ? picture.full() : picture.fit();
  else if (event.target.matches?.("input[type=range], .split-handle")) return;
  else if (event.key === "ArrowRight") next(1);
  else if (event.key === "ArrowLeft") next(-1);
  else if (/^[0-5]$/.test(event.key)) rate(Number(event.key));
  else return;
  event.preventDefault();
}

/** Stars go into the sidecar at once; edits that are not saved yet stay. */
async function rate(stars) {
  const { file, isDirty } = draft;
  if (isDirty) {
    saved.fault(new Error("Save the edits first: stars go into the same sidecar."));
    return;
  }
  try {
    const faults = await files.rate([file], stars);
    if (faults.length) throw new Error(faults[0].error);
    await draft.load();
    saved.say(stars ? `${"★".repeat(stars)} saved.` : "No stars.");
  } catch (error) {
    saved.fault(error);
  }
}

/** Sidecars were written from elsewhere on this page. */
export async function outdated(changed) {
  if (draft && changed.includes(draft.file) && !draft.isDirty) await draft.load();
}
