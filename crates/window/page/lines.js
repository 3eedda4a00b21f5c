// Lines drawn on the picture along what shall be level or upright. Where two of a kind run together, they tell the perspective;
// else the lines tell by how much the picture leans.

import { h, svg } from "./elements.js";
import { ARROWS, Tool } from "./tool.js";

/** Lines of one kind. */
const MOST = 2;
/** What is shorter is a click, pixels of the screen. */
const SHORTEST = 12;
const KINDS = { vertical: "upright", horizontal: "level" };

export class LineTool extends Tool {
  /** Each two places, in pixels of the upright picture: before perspective, straightening and crop. */
  #lines = [];
  /** What the lines were before each step. */
  #steps = [];
  #drawn = [];
  #known = [];

  constructor(picture, draft, done) {
    super(picture, draft, done, "lines");
    this.told = h("output", { class: "told" });
    this.first = h("button", { class: "first", onclick: () => this.end(true) }, "Straighten");
    this.bar = h("div", { class: "tool-bar", role: "toolbar", "aria-label": "Straighten by lines" },
      this.told,
      h("button", { title: "Put a line there that shall be level", onclick: () => this.#put("horizontal") }, "+ Level"),
      h("button", { title: "Put a line there that shall be upright", onclick: () => this.#put("vertical") }, "+ Upright"),
      h("button", { title: "Look for what is level and upright in the picture", onclick: () => this.#find() }, "Auto"),
      h("button", { class: "cancel", onclick: () => this.end(false) }, "Cancel"),
      this.first,
      this.notice.element);
    this.overlay.addEventListener("pointerdown", (event) => this.#press(event));
    this.overlay.addEventListener("keydown", (event) => this.#key(event));
  }

  begin() {
    super.begin();
    this.#lines = linesOf(this.draft.text("perspective"), this.picture.size);
    this.#known = [...this.#lines];
    this.#draw();
  }

  /** Lines are drawn on the picture as it stands without them. */
  shown(edits) {
    return { ...edits, ...LEVEL };
  }

  async chosen() {
    if (this.#auto) return this.#inPicture({ ...LEVEL, straighten: "auto" });
    if (same(this.#lines, this.#known)) return {};
    return this.#inPicture({ ...LEVEL, ...changes(this.#lines, this.picture.size) });
  }

  #auto = false;

  #find() {
    this.#auto = true;
    return this.end(true).finally(() => { this.#auto = false; });
  }

  /** With a crop that lies in what stays whole of the picture. */
  async #inPicture(changes) {
    const crop = this.draft.text("crop");
    const { shown, crop: wanted } = await this.frame({ ...this.draft.edits, ...changes });
    if (!/^\d+,/.test(crop.replaceAll(" ", ""))) return changes;
    const starts = [0, 1].map((i) => Math.max(shown[i], wanted[i]));
    const sides = [0, 1].map((i) => Math.min(shown[i] + shown[i + 2], wanted[i] + wanted[i + 2]) - starts[i]);
    return { ...changes, crop: sides.every((side) => side > 0) ? [...starts, ...sides].join() : null };
  }

  undo() {
    const before = this.#steps.pop();
    if (before) this.#lines = before;
    this.#draw();
    return true;
  }

  #step() {
    this.#steps.push(this.#lines.map((line) => [...line]));
  }

  /** A line in the middle of what is there, to be moved. */
  #put(kind) {
    const [width, height] = this.picture.size;
    const level = kind === "horizontal";
    this.#step();
    // Beside the first one.
    const share = this.#lines.some((line) => kindOf(line) === kind) ? 0.75 : 0.25;
    this.#add(level ? [[width * 0.25, height * share], [width * 0.75, height * share]] : [[width * share, height * 0.25], [width * share, height * 0.75]]);
    this.#draw();
    this.#drawn.at(-1).ends[0].focus();
  }

  /** One more line; the eldest of its kind goes where there are too many. */
  #add(line) {
    const alike = this.#lines.filter((other) => kindOf(other) === kindOf(line));
    if (alike.length >= MOST) this.#lines.splice(this.#lines.indexOf(alike[0]), 1);
    this.#lines.push(line);
  }

  /** Makes what is drawn of each line. */
  #draw() {
    this.#drawn = this.#lines.map((line, i) => ({
      ends: line.map((_, end) => svg("circle", { class: "handle", r: 7, tabindex: "0", role: "button", "data-line": String(i), "data-end": String(end) })),
      along: svg("line", { class: "along" }),
      body: svg("line", { class: "body", "data-line": String(i) }),
      label: svg("text", {}),
    }));
    this.overlay.replaceChildren(...this.#drawn.flatMap(({ along, body, label, ends }) => [along, body, label, ...ends]));
    this.lay();
  }

  lay() {
    if (!this.picture.size) return;
    this.#drawn.forEach(({ ends, along, body, label }, i) => {
      const line = this.#lines[i];
      const [a, b] = line.map((place) => this.picture.onStage(place));
      place(body, a, b);
      // Beyond its ends, to be compared with what lies farther away.
      const by = [0, 1].map((axis) => 20 * (b[axis] - a[axis]));
      place(along, a.map((v, axis) => v - by[axis]), b.map((v, axis) => v + by[axis]));
      const kind = kindOf(line);
      ends.forEach((end, at) => {
        end.setAttribute("cx", [a, b][at][0]);
        end.setAttribute("cy", [a, b][at][1]);
        end.setAttribute("aria-label", `${KINDS[kind]} line ${i + 1}, ${at ? "second" : "first"} end`);
      });
      label.textContent = `${lean(line).toFixed(2)}°`;
      label.setAttribute("x", (a[0] + b[0]) / 2 + 12);
      label.setAttribute("y", (a[1] + b[1]) / 2 - 12);
    });
    this.told.textContent = words(this.#lines);
    this.first.textContent = isPerspective(this.#lines) ? "Make upright" : "Straighten";
  }

  #press(event) {
    if (event.button !== 0 || !this.picture.size) return;
    event.preventDefault();
    event.stopPropagation();
    this.#step();
    const { line, end } = event.target.dataset;
    const start = this.picture.under(event);
    const fresh = line === undefined;
    // A new line has one end where it begins, and is dragged by the other.
    if (fresh) this.#lines.push([start, start]);
    const i = fresh ? this.#lines.length - 1 : Number(line);
    const before = this.#lines[i];
    const moved = fresh ? [1] : end === undefined ? [0, 1] : [Number(end)];
    if (fresh) this.#draw();
    this.#drawn[i].ends[moved[0]].focus();
    const move = (e) => {
      const now = this.picture.under(e);
      this.#lines[i] = before.map((place, at) => (moved.includes(at) ? this.#within(place.map((v, axis) => v + now[axis] - start[axis])) : place));
      this.lay();
    };
    const done = () => {
      this.overlay.removeEventListener("pointermove", move);
      const drawn = this.#lines.splice(i, 1)[0];
      const [a, b] = drawn;
      if (Math.hypot(b[0] - a[0], b[1] - a[1]) * this.picture.zoom < SHORTEST) return this.undo();
      if (fresh) this.#add(drawn);
      else this.#lines.splice(i, 0, drawn);
      // A click that moved nothing is no step.
      if (same(this.#lines, this.#steps.at(-1))) this.#steps.pop();
      this.notice.clear();
      this.#draw();
    };
    this.overlay.setPointerCapture(event.pointerId);
    this.overlay.addEventListener("pointermove", move);
    this.overlay.addEventListener("pointerup", done, { once: true });
    this.overlay.addEventListener("pointercancel", done, { once: true });
  }

  #within(place) {
    return place.map((v, axis) => Math.min(this.picture.size[axis], Math.max(0, v)));
  }

  #key(event) {
    const { line, end } = event.target.dataset ?? {};
    if (end === undefined) return;
    const remove = event.key === "Delete" || event.key === "Backspace";
    const step = ARROWS[event.key];
    if (!remove && !step) return;
    event.preventDefault();
    event.stopPropagation();
    this.#step();
    if (remove) {
      this.#lines.splice(Number(line), 1);
      return this.#draw();
    }
    const far = (event.shiftKey ? 10 : 1) / this.picture.zoom;
    const places = [...this.#lines[line]];
    places[end] = this.#within(places[end].map((v, axis) => v + step[axis] * far));
    this.#lines[line] = places;
    this.lay();
  }
}

/** The settings of a picture as it was held. */
const LEVEL = { straighten: "0", perspective: "off" };

const same = (lines, others) => JSON.stringify(lines) === JSON.stringify(others);

const kindOf = ([a, b]) => (Math.abs(b[0] - a[0]) > Math.abs(b[1] - a[1]) ? "horizontal" : "vertical");

const of = (kind, lines) => lines.filter((line) => kindOf(line) === kind);

/** Degrees by which the picture is to be turned clockwise for a line to be level or upright. */
function lean([a, b]) {
  const [x, y] = [b[0] - a[0], b[1] - a[1]];
  const radians = kindOf([a, b]) === "horizontal" ? -Math.atan(y / x) : Math.atan(x / y);
  return (radians * 180) / Math.PI || 0;
}

const mean = (lines) => lines.reduce((sum, line) => sum + lean(line), 0) / lines.length;

const isPerspective = (lines) => Object.keys(KINDS).some((kind) => of(kind, lines).length === 2);

/** What lines ask for. */
function changes(lines, [width, height]) {
  if (!lines.length) return {};
  if (!isPerspective(lines)) return { straighten: number(mean(lines), 2) };
  const share = ([x, y]) => `${number((100 * x) / width, 3)}%,${number((100 * y) / height, 3)}%`;
  const kinds = Object.keys(KINDS).filter((kind) => of(kind, lines).length);
  return { perspective: kinds.map((kind) => `${kind}:${of(kind, lines).flat().map(share).join()}`).join(";") };
}

function words(lines) {
  if (!lines.length) return "Draw a line along what shall be level or upright; two of a kind undo perspective";
  if (!isPerspective(lines)) return `Turns ${number(Math.abs(mean(lines)), 2)}° ${mean(lines) < 0 ? "anticlockwise" : "clockwise"}`;
  return `Perspective by ${Object.entries(KINDS).map(([kind, word]) => [of(kind, lines).length, word]).filter(([count]) => count).map(([count, word]) => `${count} ${word}`).join(" and ")}`;
}

/** The lines of a setting of perspective; the sides of a rectangle are lines, too. */
function linesOf(text, size) {
  const places = (part) => {
    const numbers = part.split(",").map((one, i) => (one.includes("%") ? (parseFloat(one) / 100) * size[i % 2] : parseFloat(one)));
    return numbers.flatMap((_, i) => (i % 2 ? [] : [[numbers[i], numbers[i + 1]]]));
  };
  if (!/\d/.test(text)) return [];
  if (!text.includes(":")) {
    const [a, b, c, d] = places(text);
    return [[a, d], [b, c], [a, b], [d, c]];
  }
  return text.split(";").flatMap((part) => {
    const all = places(part.slice(part.indexOf(":") + 1));
    return all.length === 4 ? [all.slice(0, 2), all.slice(2)] : [all];
  });
}

const number = (value, digits) => String(Number(value.toFixed(digits)));

function place(line, a, b) {
  for (const [name, v] of Object.entries({ x1: a[0], y1: a[1], x2: b[0], y2: b[1] })) line.setAttribute(name, v);
}
