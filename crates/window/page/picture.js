// A picture to look at: fitted or pixel for pixel, moved by dragging and the wheel, sharp tiles over coarse ones.

import { h, later } from "./elements.js";
import { Layer } from "./layer.js";

/** Up to this zoom the whole picture is rendered at half its size. */
const HALF = 0.5;
/** While something moves that must show noise as it is, a picture of this share of the screen's pixels is enough. */
const NOISELESS = 0.5;
const LARGEST_ZOOM = 8;

/**
 * The stage. `asked()` says what is rendered, `askedBefore()` what is shown before the edits. Events: `view` when the place
 * changes, `rendered` with what a picture told, `fault` with an error.
 */
export class Picture extends EventTarget {
  #zoom = 1;
  #fitted = true;
  #at = [0, 0];
  #size = null;
  #split = null;

  constructor(asked, askedBefore) {
    super();
    this.main = new Layer("main", asked);
    this.before = askedBefore ? new Layer("before", askedBefore) : null;
    this.sheet = h("div", { class: "paper" }, this.main.element, this.before?.element);
    this.handle = h("div", { class: "split-handle", role: "separator", "aria-label": "Before and after", tabindex: "0", hidden: true });
    this.element = h("div", { class: "stage", tabindex: "0", role: "img", "aria-label": "The picture" }, this.sheet, this.handle);
    this.#settle = later(250, () => this.#sharpen());
    new ResizeObserver(() => this.#resized()).observe(this.element);
    this.#drags();
    this.#splits();
  }

  #settle;
  /** Pictures that are on their way: what is seen is made sharp after them. */
  #updates = 0;
  /** Whether what changes has nothing to do with noise. */
  mayBeNoisy = true;

  get size() {
    return this.#size;
  }

  get zoom() {
    return this.#zoom;
  }

  get isFitted() {
    return this.#fitted;
  }

  /** Another file, or another size of it: everything from the beginning. */
  reset() {
    this.main.clear();
    this.before?.clear();
    this.#size = null;
    this.#fitted = true;
  }

  /** Renders anew; quickly, if more is to follow at once. */
  async update(quick = false) {
    this.#updates += 1;
    this.element.classList.add("busy");
    try {
      await this.main.whole(this.#longest() * (quick && !this.mayBeNoisy ? NOISELESS : 1), quick && this.mayBeNoisy);
      if (!this.main.about) return;
      this.#take(this.main.about);
      this.#settle();
    } catch (error) {
      if (error.name !== "AbortError" && error.status !== 409) this.dispatchEvent(new CustomEvent("fault", { detail: error }));
    } finally {
      this.#updates -= 1;
      this.element.classList.toggle("busy", this.#updates > 0);
    }
  }

  #take(about) {
    const [width, height] = about.size;
    if (!this.#size || this.#size[0] !== width || this.#size[1] !== height) {
      this.#size = [width, height];
      if (this.#fitted) this.fit();
    }
    this.#lay();
    this.dispatchEvent(new CustomEvent("rendered", { detail: about }));
  }

  /** Pixels of the screen that the longer side of the picture takes. */
  #longest() {
    const { clientWidth, clientHeight } = this.element;
    const dpr = devicePixelRatio;
    if (!this.#size) return Math.max(clientWidth, clientHeight, 400) * dpr;
    // Where tiles are shown, what lies below them may be coarse.
    return Math.max(...this.#size) * (this.#tiled ? this.#fitZoom() : this.#zoom) * dpr;
  }

  /** Whether the picture is so large that only what is seen of it is rendered sharp. */
  get #tiled() {
    return !this.#fitted && this.#zoom * devicePixelRatio > HALF;
  }

  #fitZoom() {
    const { clientWidth, clientHeight } = this.element;
    const margin = 2 * MARGIN;
    return Math.min((clientWidth - margin) / this.#size[0], (clientHeight - margin) / this.#size[1], 1 / devicePixelRatio);
  }

  fit() {
    if (!this.#size) return;
    this.#fitted = true;
    this.#zoom = this.#fitZoom();
    const { clientWidth, clientHeight } = this.element;
    this.#at = [(clientWidth - this.#size[0] * this.#zoom) / 2, (clientHeight - this.#size[1] * this.#zoom) / 2];
    this.#lay();
    this.#settle();
  }

  /** Pixel for pixel about a place of the stage, its middle if none is given. */
  full(place) {
    this.zoomTo(1 / devicePixelRatio, place);
  }

  zoomTo(zoom, place = [this.element.clientWidth / 2, this.element.clientHeight / 2]) {
    if (!this.#size) return;
    const fit = this.#fitZoom();
    if (zoom <= fit * 1.001) return this.fit();
    zoom = Math.min(zoom, LARGEST_ZOOM / devicePixelRatio);
    this.#at = [0, 1].map((i) => place[i] - ((place[i] - this.#at[i]) * zoom) / this.#zoom);
    this.#zoom = zoom;
    this.#fitted = false;
    this.#bound();
    this.#lay();
    this.#settle();
  }

  /** A place of the window in pixels of the picture, or `null` beside it. */
  at(event) {
    if (!this.#size) return null;
    const place = this.under(event);
    return place.every((v, i) => v >= 0 && v < this.#size[i]) ? place : null;
  }

  /** A place of the window in pixels of the picture, also beside it. */
  under(event) {
    const box = this.element.getBoundingClientRect();
    return [(event.clientX - box.left - this.#at[0]) / this.#zoom, (event.clientY - box.top - this.#at[1]) / this.#zoom];
  }

  /** A place of the picture in pixels of the stage. */
  onStage(place) {
    return place.map((v, i) => this.#at[i] + v * this.#zoom);
  }

  #resized() {
    if (!this.#size || !this.element.clientWidth) return;
    if (this.#fitted) this.fit();
    else this.#bound();
    this.#lay();
    this.#settle();
  }

  /** What is larger than the stage covers it. */
  #bound() {
    const room = [this.element.clientWidth, this.element.clientHeight];
    this.#at = this.#at.map((v, i) => {
      const length = this.#size[i] * this.#zoom;
      return length <= room[i] ? (room[i] - length) / 2 : Math.min(MARGIN, Math.max(room[i] - length - MARGIN, v));
    });
  }

  #lay() {
    if (!this.#size) return;
    const [width, height] = this.#size.map((v) => v * this.#zoom);
    this.sheet.style.cssText = `left:${this.#at[0]}px;top:${this.#at[1]}px;width:${width}px;height:${height}px`;
    this.sheet.classList.toggle("pixels", this.#zoom * devicePixelRatio >= 2);
    this.#laySplit();
    this.dispatchEvent(new Event("view"));
  }

  /** The part of the picture that is seen. */
  #seen() {
    const room = [this.element.clientWidth, this.element.clientHeight];
    const start = this.#at.map((v) => -v / this.#zoom);
    return [start[0], start[1], start[0] + room[0] / this.#zoom, start[1] + room[1] / this.#zoom];
  }

  /** Nothing moves: what is seen gets as sharp as the screen is. */
  async #sharpen() {
    if (!this.#size || !this.main.about || this.#updates > 0 || !this.element.clientWidth) return;
    const failed = (error) => {
      if (error.name !== "AbortError" && error.status !== 409) this.dispatchEvent(new CustomEvent("fault", { detail: error }));
    };
    const longest = this.#longest();
    for (const layer of [this.main, this.#split === null && !this.#held ? null : this.before]) {
      if (!layer) continue;
      try {
        if (!layer.isFine(longest)) {
          const about = await layer.whole(longest);
          if (about && layer === this.main) this.#take(about);
        }
      } catch (error) {
        return failed(error);
      }
      const { about } = layer;
      if (!about || this.#updates > 0) return;
      if (this.#tiled && about.bin > 1) layer.tiles(this.#seen(), failed);
      else layer.noTiles();
    }
  }

  #drags() {
    const { element } = this;
    element.addEventListener("wheel", (event) => {
      event.preventDefault();
      const box = element.getBoundingClientRect();
      const by = Math.exp(-event.deltaY * (event.deltaMode === 1 ? 0.05 : 0.0016));
      this.zoomTo(this.#zoom * by, [event.clientX - box.left, event.clientY - box.top]);
    }, { passive: false });
    element.addEventListener("pointerdown", (event) => {
      if (event.button !== 0 || this.busy || event.target.closest(".handle, .patch, .split-handle")) return;
      const from = [event.clientX, event.clientY];
      const at = this.#at;
      let far = false;
      element.setPointerCapture(event.pointerId);
      const move = (e) => {
        far ||= Math.hypot(e.clientX - from[0], e.clientY - from[1]) > 4;
        if (!far || this.#fitted) return;
        this.#at = [at[0] + e.clientX - from[0], at[1] + e.clientY - from[1]];
        element.classList.add("moving");
        this.#bound();
        this.#lay();
        this.#settle();
      };
      const end = (e) => {
        element.removeEventListener("pointermove", move);
        element.classList.remove("moving");
        if (!far && e.type === "pointerup") this.dispatchEvent(new CustomEvent("press", { detail: e }));
      };
      element.addEventListener("pointermove", move);
      element.addEventListener("pointerup", end, { once: true });
      element.addEventListener("pointercancel", end, { once: true });
    });
    element.addEventListener("dblclick", (event) => {
      if (this.busy) return;
      const box = element.getBoundingClientRect();
      if (this.#fitted) this.full([event.clientX - box.left, event.clientY - box.top]);
      else this.fit();
    });
  }

  #held = false;

  /** Shows what was before the edits, while a key is held. */
  async hold(held) {
    if (!this.before || held === this.#held) return;
    this.#held = held;
    if (held) await this.#bringBefore();
    this.#laySplit();
  }

  /** Before at the left, after at the right of a handle. */
  async split(yes) {
    this.#split = yes ? 0.5 : null;
    if (yes) await this.#bringBefore();
    this.#laySplit();
  }

  get isSplit() {
    return this.#split !== null;
  }

  async #bringBefore() {
    try {
      await this.before.whole(this.#longest());
      this.#settle();
    } catch (error) {
      if (error.name !== "AbortError") this.dispatchEvent(new CustomEvent("fault", { detail: error }));
    }
  }

  #laySplit() {
    if (!this.before) return;
    const share = this.#held ? 1 : (this.#split ?? 0);
    this.before.element.style.clipPath = `inset(0 ${100 - 100 * share}% 0 0)`;
    this.before.element.hidden = share === 0;
    this.handle.hidden = this.#split === null || this.#held || !this.#size;
    if (!this.#size) return;
    this.handle.style.left = `${this.#at[0] + share * this.#size[0] * this.#zoom}px`;
    this.handle.setAttribute("aria-valuenow", String(Math.round(100 * share)));
  }

  #splits() {
    const { handle } = this;
    handle.addEventListener("pointerdown", (event) => {
      event.stopPropagation();
      handle.setPointerCapture(event.pointerId);
      const move = (e) => {
        const x = e.clientX - this.element.getBoundingClientRect().left;
        this.#split = Math.min(1, Math.max(0, (x - this.#at[0]) / (this.#size[0] * this.#zoom)));
        this.#laySplit();
      };
      handle.addEventListener("pointermove", move);
      handle.addEventListener("pointerup", () => handle.removeEventListener("pointermove", move), { once: true });
    });
    handle.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
      if (!by) return;
      event.preventDefault();
      event.stopPropagation();
      this.#split = Math.min(1, Math.max(0, this.#split + by));
      this.#laySplit();
    });
  }
}

/** Grey round a fitted picture, pixels of the page. */
const MARGIN = 16;
