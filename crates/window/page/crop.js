// The crop and the straightening, chosen on the picture: a rectangle with handles; dragging outside of it turns the picture.

import { h, svg } from "./elements.js";
import { ARROWS, Tool } from "./tool.js";

const HANDLES = [[0, 0], [0.5, 0], [1, 0], [1, 0.5], [1, 1], [0.5, 1], [0, 1], [0, 0.5]];
/** The smallest side of a crop, pixels of the picture. */
const LEAST = 16;
const RATIOS = ["free", "3:2", "4:3", "5:4", "1:1", "16:9"];

export class CropTool extends Tool {
  #frame = null;
  /** In pixels of what is shown: left, top, right, bottom. */
  #box = null;
  #ratio = null;

  constructor(picture, draft, done) {
    super(picture, draft, done, "crop");
    this.shade = svg("path", { class: "shade", "fill-rule": "evenodd" });
    this.edge = svg("rect", { class: "edge" });
    this.thirds = svg("path", { class: "thirds" });
    this.handles = HANDLES.map((_, i) => svg("circle", { class: "handle", r: 7, tabindex: "0", "data-handle": String(i) }));
    this.overlay.append(this.shade, this.thirds, this.edge, ...this.handles);
    this.ratio = h("select", { "aria-label": "Ratio of sides", onchange: () => this.#take(this.ratio.value) }, RATIOS.map((ratio) => h("option", {}, ratio)));
    this.angle = h("output", { class: "angle" });
    this.bar = h("div", { class: "tool-bar", role: "toolbar", "aria-label": "Crop" },
      h("span", {}, "Sides"), this.ratio,
      h("span", { title: "Drag outside of the rectangle to turn the picture" }, "Angle"), this.angle,
      h("button", { onclick: () => this.#turn(-0.1), "aria-label": "Turn a tenth of a degree anticlockwise" }, "−"),
      h("button", { onclick: () => this.#turn(0.1), "aria-label": "Turn a tenth of a degree clockwise" }, "+"),
      h("button", { onclick: () => this.#whole() }, "Whole picture"),
      h("button", { class: "cancel", onclick: () => this.end(false) }, "Cancel"),
      h("button", { class: "first", onclick: () => this.end(true) }, "Crop"),
      this.notice.element);
    this.#wasStraight = draft.edits.straighten ?? null;
    this.overlay.addEventListener("pointerdown", (event) => this.#press(event));
    this.overlay.addEventListener("keydown", (event) => this.#key(event));
  }

  #wasStraight;

  async begin() {
    super.begin();
    await this.#measure();
  }

  /** Where a crop can lie, as the settings are now. */
  async #measure() {
    const frame = await this.frame(this.draft.edits);
    const [left, top, width, height] = frame.shown;
    const [x, y, w, hgt] = frame.crop;
    this.#frame = frame;
    const box = this.#box ?? [x - left, y - top, x - left + w, y - top + hgt];
    const limit = (v, most) => Math.min(most, Math.max(0, v));
    this.#box = [limit(box[0], width - LEAST), limit(box[1], height - LEAST), limit(box[2], width), limit(box[3], height)];
    this.lay();
  }

  async chosen() {
    // The picture may have been turned a moment ago.
    await this.#measure().catch(() => {});
    if (!this.#frame) return this.undone();
    const [left, top, width, height] = this.#frame.shown;
    const [x0, y0, x1, y1] = this.#box.map(Math.round);
    const isWhole = x0 <= 0 && y0 <= 0 && x1 >= width && y1 >= height;
    return { crop: isWhole ? null : `${left + x0},${top + y0},${x1 - x0},${y1 - y0}` };
  }

  undone() {
    return { straighten: this.#wasStraight };
  }

  #whole() {
    const [, , width, height] = this.#frame.shown;
    this.#box = [0, 0, width, height];
    this.lay();
  }

  #take(ratio) {
    if (ratio === "free") {
      this.#ratio = null;
      return;
    }
    const [a, b] = ratio.split(":").map(Number);
    const [, , width, height] = this.#frame.shown;
    this.#ratio = width >= height ? a / b : b / a;
    // As large as it fits into what was chosen.
    const [x0, y0, x1, y1] = this.#box;
    const w = Math.min(x1 - x0, (y1 - y0) * this.#ratio);
    const hgt = w / this.#ratio;
    const [cx, cy] = [(x0 + x1) / 2, (y0 + y1) / 2];
    this.#box = [cx - w / 2, cy - hgt / 2, cx + w / 2, cy + hgt / 2];
    this.lay();
  }

  async #turn(by) {
    const angle = Math.min(45, Math.max(-45, (Number(this.draft.text("straighten")) || 0) + by));
    this.draft.set({ straighten: angle.toFixed(2).replace(/\.?0+$/, "") });
    this.lay();
    await this.#measure();
  }

  lay() {
    this.angle.textContent = `${(Number(this.draft.text("straighten")) || 0).toFixed(1)}°`;
    if (!this.#box) return;
    const [[x0, y0], [x1, y1]] = [this.#box.slice(0, 2), this.#box.slice(2)].map((place) => this.picture.onStage(place));
    const { clientWidth, clientHeight } = this.picture.element;
    this.shade.setAttribute("d", `M0 0H${clientWidth}V${clientHeight}H0ZM${x0} ${y0}H${x1}V${y1}H${x0}Z`);
    for (const [name, v] of Object.entries({ x: x0, y: y0, width: x1 - x0, height: y1 - y0 })) this.edge.setAttribute(name, v);
    const third = (a, b, i) => a + ((b - a) * i) / 3;
    this.thirds.setAttribute("d", [1, 2].map((i) => `M${third(x0, x1, i)} ${y0}V${y1}M${x0} ${third(y0, y1, i)}H${x1}`).join(""));
    this.handles.forEach((handle, i) => {
      handle.setAttribute("cx", x0 + (x1 - x0) * HANDLES[i][0]);
      handle.setAttribute("cy", y0 + (y1 - y0) * HANDLES[i][1]);
    });
  }

  #press(event) {
    if (event.button !== 0 || !this.#box) return;
    event.preventDefault();
    event.stopPropagation();
    const handle = event.target.dataset?.handle;
    const start = [event.clientX, event.clientY];
    const box = [...this.#box];
    const zoom = this.picture.zoom;
    const inside = event.target === this.edge;
    const area = this.picture.element.getBoundingClientRect();
    const middle = [area.left + area.width / 2, area.top + area.height / 2];
    const direction = (e) => Math.atan2(e.clientY - middle[1], e.clientX - middle[0]);
    const from = direction(event);
    const angle = (Number(this.draft.text("straighten")) || 0);
    const move = (e) => {
      const by = [(e.clientX - start[0]) / zoom, (e.clientY - start[1]) / zoom];
      if (handle !== undefined) this.#drag(box, HANDLES[handle], by);
      else if (inside) this.#shift(box, by);
      else this.draft.set({ straighten: (Math.max(-45, Math.min(45, angle + ((direction(e) - from) * 180) / Math.PI))).toFixed(1) });
      this.lay();
    };
    const end = () => {
      this.overlay.removeEventListener("pointermove", move);
      if (handle === undefined && !inside) this.#measure();
    };
    this.overlay.setPointerCapture(event.pointerId);
    this.overlay.addEventListener("pointermove", move);
    this.overlay.addEventListener("pointerup", end, { once: true });
    this.overlay.addEventListener("pointercancel", end, { once: true });
  }

  #shift(box, by) {
    const [, , width, height] = this.#frame.shown;
    const dx = Math.min(width - box[2], Math.max(-box[0], by[0]));
    const dy = Math.min(height - box[3], Math.max(-box[1], by[1]));
    this.#box = [box[0] + dx, box[1] + dy, box[2] + dx, box[3] + dy];
  }

  #drag(box, [u, v], by) {
    const [, , width, height] = this.#frame.shown;
    let [x0, y0, x1, y1] = box;
    if (u === 0) x0 = Math.min(x1 - LEAST, Math.max(0, x0 + by[0]));
    if (u === 1) x1 = Math.max(x0 + LEAST, Math.min(width, x1 + by[0]));
    if (v === 0) y0 = Math.min(y1 - LEAST, Math.max(0, y0 + by[1]));
    if (v === 1) y1 = Math.max(y0 + LEAST, Math.min(height, y1 + by[1]));
    if (this.#ratio) {
      let w = u === 0.5 ? (y1 - y0) * this.#ratio : x1 - x0;
      w = Math.min(w, u === 0 ? x1 : u === 1 ? width - x0 : width, (v === 0 ? y1 : v === 1 ? height - y0 : height) * this.#ratio);
      const hgt = w / this.#ratio;
      if (u === 0) x0 = x1 - w;
      else x1 = x0 + w;
      if (v === 0) y0 = y1 - hgt;
      else y1 = y0 + hgt;
      if (x1 > width || y1 > height || x0 < 0 || y0 < 0) return;
    }
    this.#box = [x0, y0, x1, y1];
  }

  #key(event) {
    const step = ARROWS[event.key];
    const handle = event.target.dataset?.handle;
    if (!step || handle === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    const far = event.shiftKey ? 50 : 5;
    this.#drag(this.#box, HANDLES[handle], step.map((v) => v * far));
    this.lay();
  }
}
