// The contact sheet: only the cells that can be seen are there, whatever the number of files.

import { address, post } from "./server.js";
import { baseName, fill, h, isTyping, Notice, shown } from "./elements.js";
import { SORTS, files } from "./files.js";
import { clipboard, hasDraft } from "./edits.js";

const GAP = 8;
const UNDER = 44;

const wanted = { text: "", sort: "name", down: false, camera: "", stars: 0, state: "" };
const notice = new Notice();
const cells = new Map();
/** Pixels of the longer side below which a picture is coarse. */
const COARSE = 300;
const REFINED_AT_ONCE = 3;
/** Coarse pictures, and those that are on their way. */
const refined = [];
const waited = new Set();
let width = innerWidth < 2800 ? 190 : 280;
let columns = 1;
let focused = 0;
let anchor = 0;
let root, scroller, canvas, count, cameras, actions, go;

/** Builds the view. `open(file)` shows a file in the develop view. */
export function build(element, routes) {
  root = element;
  go = routes;
  count = h("span", { class: "count", role: "status" });
  cameras = select("Camera", "camera", [["", "Every camera"]]);
  actions = h("div", { class: "actions" });
  canvas = h("div", { class: "cells" });
  scroller = h("div", {
    class: "cells-frame",
    tabindex: "0",
    role: "listbox",
    "aria-multiselectable": "true",
    "aria-label": "Photographs",
    onkeydown: key,
  }, canvas);
  const sorts = { name: "Name", folder: "Folder", date: "Date", camera: "Camera", iso: "ISO", stars: "Rating", size: "Size" };
  fill(
    root,
    h("div", { class: "tools" },
      h("input", { type: "search", placeholder: "Find by name", "aria-label": "Find by name", oninput: (e) => ask("text", e.target.value) }),
      select("Sort by", "sort", Object.keys(SORTS).map((name) => [name, sorts[name]])),
      h("button", { class: "quiet", title: "Turn the order round", "aria-label": "Turn the order round", onclick: turn }, "↑"),
      cameras,
      select("Rating", "stars", [[0, "Any rating"], ...[1, 2, 3, 4, 5].map((n) => [n, "★".repeat(n) + (n < 5 ? " or more" : "")])]),
      select("State", "state", [["", "Any state"], ["edited", "Edited"], ["unedited", "Not edited"], ["done", "Developed by a batch"], ["failed", "Failed in a batch"], ["fault", "Cannot be read"]]),
      count,
      h("button", { class: "quiet", title: "Read the folders again", "aria-label": "Read the folders again", onclick: load }, "⟳"),
      h("span", { class: "space" }),
      actions,
      h("input", { type: "range", min: 130, max: 360, value: width, class: "short", title: "Size of the pictures", "aria-label": "Size of the pictures", oninput: (e) => { width = Number(e.target.value); layOut(); } }),
    ),
    notice.element,
    scroller,
  );
  files.addEventListener("change", () => { arrange(); });
  scroller.addEventListener("scroll", () => requestAnimationFrame(draw), { passive: true });
  new ResizeObserver(layOut).observe(scroller);
}

export async function show() {
  scroller.focus({ preventScroll: true });
  if (!files.all.length) await load();
  else arrange();
}

/** Reads the folders again. */
export async function load() {
  try {
    await files.load();
    notice.fault(files.faults.length ? new Error(files.faults.join(" ")) : null);
  } catch (error) {
    notice.fault(error);
  }
  arrange();
}

function select(label, name, options) {
  return h("select", { "aria-label": label, title: label, onchange: (e) => ask(name, e.target.value) },
    options.map(([value, text]) => h("option", { value: String(value) }, text)));
}

function ask(name, value) {
  wanted[name] = name === "stars" ? Number(value) : value;
  focused = anchor = 0;
  scroller.scrollTop = 0;
  arrange();
}

function turn(event) {
  wanted.down = !wanted.down;
  event.target.textContent = wanted.down ? "↓" : "↑";
  arrange();
}

function arrange() {
  files.arrange(wanted);
  const [all, seen] = [files.all.length, files.shown.length];
  const photographs = all === 1 ? "photograph" : "photographs";
  count.textContent = seen === all ? `${all.toLocaleString("en")} ${photographs}` : `${seen.toLocaleString("en")} of ${all.toLocaleString("en")}`;
  const known = files.cameras();
  if (cameras.length !== known.length + 1) {
    fill(cameras, [["", "Every camera"], ...known.map((name) => [name, name])].map(([value, text]) => h("option", { value, selected: value === wanted.camera }, text)));
  }
  focused = Math.min(focused, Math.max(0, seen - 1));
  layOut();
}

function layOut() {
  const inner = scroller.clientWidth - GAP;
  columns = Math.max(1, Math.floor(inner / (width + GAP)));
  const rows = Math.ceil(files.shown.length / columns);
  canvas.style.height = `${rows * rowHeight() + GAP}px`;
  draw();
}

const cellWidth = () => Math.floor((scroller.clientWidth - GAP) / columns) - GAP;
const rowHeight = () => Math.round(cellWidth() * 0.72) + UNDER + GAP;

function draw() {
  if (root.hidden) return;
  const height = rowHeight();
  const first = Math.max(0, Math.floor(scroller.scrollTop / height) - 1) * columns;
  const last = Math.min(files.shown.length, (Math.ceil((scroller.scrollTop + scroller.clientHeight) / height) + 1) * columns);
  const seen = new Set();
  const unread = [];
  for (let i = first; i < last; i++) {
    const { file, modified } = files.shown[i];
    seen.add(file);
    if (!files.facts.has(file)) unread.push(file);
    place(cells.get(file) ?? made(file, modified), i, file, height);
  }
  for (const [file, cell] of cells) {
    if (seen.has(file)) continue;
    // What is not looked at any more need not be loaded.
    waited.delete(cell.image);
    cell.image.src = "";
    cell.element.remove();
    cells.delete(file);
  }
  if (unread.length) files.read(unread);
  empty();
  tools();
}

function made(file, modified) {
  const image = h("img", { alt: "", decoding: "async", draggable: false });
  const cell = {
    image,
    name: h("span", { class: "name" }, baseName(file)),
    stars: h("span", { class: "stars" }),
    badge: h("span", { class: "badge" }),
  };
  const picture = h("div", { class: "thumb" }, image, cell.badge);
  const fine = address("small", { file, v: modified });
  image.onload = () => {
    picture.classList.add("there");
    if (Math.max(image.naturalWidth, image.naturalHeight) < COARSE && image.src !== fine) refined.push({ image, fine });
    arrived(image);
  };
  image.onerror = () => {
    if (!image.getAttribute("src")) return;
    picture.classList.add("broken");
    arrived(image);
  };
  waited.add(image);
  image.src = address("small", { file, v: modified, quick: true });
  cell.element = h("div", {
    class: "cell",
    role: "option",
    title: shown(file.slice(file.indexOf("/") + 1)),
    onclick: (event) => choose(files.shown.findIndex((one) => one.file === file), event),
    ondblclick: () => go.develop(file),
  }, picture, h("div", { class: "under" }, cell.name, cell.stars));
  cells.set(file, cell);
  canvas.append(cell.element);
  return cell;
}

function arrived(image) {
  waited.delete(image);
  refine();
}

/** Coarse pictures become fine ones when none is missing any more, a few at a time. */
function refine() {
  while (waited.size < REFINED_AT_ONCE && refined.length) {
    const { image, fine } = refined.shift();
    if (!image.isConnected) continue;
    waited.add(image);
    image.src = fine;
  }
}

function place(cell, i, file, height) {
  const w = cellWidth();
  const [x, y] = [GAP + (i % columns) * (w + GAP), GAP + Math.floor(i / columns) * height];
  const { element } = cell;
  element.style.cssText = `width:${w}px;height:${height - GAP}px;transform:translate(${x}px,${y}px)`;
  element.id = `cell-${i}`;
  const facts = files.facts.get(file);
  element.classList.toggle("focused", i === focused);
  const isChosen = files.chosen.has(file);
  element.classList.toggle("chosen", isChosen);
  element.setAttribute("aria-selected", String(isChosen));
  const stars = facts?.stars ?? 0;
  cell.stars.textContent = "★".repeat(stars);
  cell.stars.setAttribute("aria-label", stars ? `${stars} stars` : "");
  const fault = facts?.fault ?? facts?.settings_fault;
  const state = files.states.get(file);
  const [kind, text] = fault ? ["fault", "cannot be read"] : hasDraft(file) ? ["draft", "not saved"] : state === "failed" ? ["fault", "failed"] : state === "done" ? ["done", "developed"] : facts?.edited ? ["edited", "edited"] : ["", ""];
  cell.badge.dataset.kind = kind;
  cell.badge.textContent = text;
  cell.badge.title = fault ?? "";
}

function empty() {
  scroller.querySelector(".empty")?.remove();
  if (files.shown.length) {
    scroller.setAttribute("aria-activedescendant", `cell-${focused}`);
    return;
  }
  const words = files.all.length ? "No photograph fits what is asked for above." : "There are no raw files in what was opened.";
  scroller.append(h("p", { class: "empty" }, words));
}

function tools() {
  const chosen = files.chosen.size;
  fill(actions,
    chosen > 0 && h("span", { class: "count" }, `${chosen} chosen`),
    chosen > 0 && clipboard.names.length > 0 && h("button", { onclick: paste, title: clipboard.names.join(", ") }, `Paste settings of ${clipboard.from}`),
    chosen > 0 && h("button", { onclick: () => go.batch([...files.chosen]) }, "Develop chosen"),
  );
}

async function paste() {
  const chosen = [...files.chosen];
  try {
    const told = await post("edits/copy", { files: chosen, edits: clipboard.edits, settings: clipboard.names });
    if (told.faults.length) notice.fault(new Error(told.faults.map((fault) => fault.error).join(" ")));
    else notice.say(`Settings were copied to ${told.done} ${told.done === 1 ? "file" : "files"}.`);
    files.again(chosen);
    go.changed(chosen);
  } catch (error) {
    notice.fault(error);
  }
}

function choose(i, event) {
  const file = files.shown[i]?.file;
  if (!file) return;
  if (event.shiftKey) {
    files.chosen = new Set(files.shown.slice(Math.min(i, anchor), Math.max(i, anchor) + 1).map((one) => one.file));
  } else if (event.ctrlKey || event.metaKey) {
    if (!files.chosen.delete(file)) files.chosen.add(file);
    anchor = i;
  } else {
    files.chosen = new Set([file]);
    anchor = i;
  }
  focused = i;
  files.current = file;
  into(i);
  draw();
}

function into(i) {
  const height = rowHeight();
  const top = Math.floor(i / columns) * height;
  if (top < scroller.scrollTop) scroller.scrollTop = top;
  else if (top + height + GAP > scroller.scrollTop + scroller.clientHeight) scroller.scrollTop = top + height + GAP - scroller.clientHeight;
}

async function key(event) {
  if (isTyping(event)) return;
  const page = Math.max(1, Math.floor(scroller.clientHeight / rowHeight())) * columns;
  const steps = { ArrowRight: 1, ArrowLeft: -1, ArrowDown: columns, ArrowUp: -columns, PageDown: page, PageUp: -page, Home: -Infinity, End: Infinity };
  const file = files.shown[focused]?.file;
  if (event.key in steps) {
    const i = Math.min(files.shown.length - 1, Math.max(0, focused + steps[event.key]));
    choose(i, { shiftKey: event.shiftKey });
  } else if (event.key === "Enter" && file) {
    go.develop(file);
  } else if (event.key === " " && file) {
    choose(focused, { ctrlKey: true });
  } else if (event.key === "Escape") {
    files.chosen.clear();
    draw();
  } else if (event.key === "a" && (event.ctrlKey || event.metaKey)) {
    files.chosen = new Set(files.shown.map((one) => one.file));
    draw();
  } else if (/^[0-5]$/.test(event.key) && file && !event.ctrlKey && !event.metaKey) {
    const chosen = files.chosen.size ? [...files.chosen] : [file];
    try {
      const faults = await files.rate(chosen, Number(event.key));
      notice.fault(faults.length ? new Error(faults.map((fault) => fault.error).join(" ")) : null);
      go.changed(chosen);
    } catch (error) {
      notice.fault(error);
    }
  } else {
    return;
  }
  event.preventDefault();
}
