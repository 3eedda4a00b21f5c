// One rendering of a picture: a coarse whole, and sharp tiles over it.

import { TAB, render } from "./server.js";
import { h } from "./elements.js";

/** Side of a tile, pixels of the picture. */
const TILE = 512;

/** `asked()` gives what to render. */
export class Layer {
  about = null;
  #tiles = new Map();
  #whole = null;
  #wanted = 0;
  #busy = null;

  constructor(name, asked) {
    this.name = name;
    this.asked = asked;
    this.element = h("div", { class: `layer ${name}` });
  }

  /** Renders the whole so that its longer side has so many pixels, and takes tiles away that are of yesterday. */
  async whole(longest, quick = false) {
    this.#dropTiles();
    this.#busy?.abort();
    const control = (this.#busy = new AbortController());
    const place = `${TAB}:${this.name}`;
    const { image, about } = await render({ ...this.asked(), place, longest: Math.ceil(longest), quick }, control.signal);
    if (control.signal.aborted) return null;
    this.about = about;
    this.#wanted = quick ? 0 : longest;
    image.className = "whole";
    image.alt = "";
    image.draggable = false;
    if (this.#whole) this.#whole.replaceWith(image);
    else this.element.prepend(image);
    this.#whole = image;
    return about;
  }

  /** Whether the whole has enough pixels for that size. */
  isFine(longest) {
    return this.about !== null && this.#wanted > 0 && (this.about.bin === 1 || this.#wanted >= longest);
  }

  /** Asks for the tiles of a part of the picture that are missing, from its middle outwards. */
  tiles([left, top, right, bottom], failed) {
    const [width, height] = this.about.size;
    const seen = new Set();
    const wanted = [];
    for (let y = Math.max(0, Math.floor(top / TILE)); y * TILE < Math.min(bottom, height); y++) {
      for (let x = Math.max(0, Math.floor(left / TILE)); x * TILE < Math.min(right, width); x++) {
        const key = `${x},${y}`;
        seen.add(key);
        if (!this.#tiles.has(key)) wanted.push({ key, x, y, far: Math.hypot(x + 0.5 - (left + right) / 2 / TILE, y + 0.5 - (top + bottom) / 2 / TILE) });
      }
    }
    for (const [key, tile] of this.#tiles) if (!seen.has(key)) this.#drop(key, tile);
    for (const { key, x, y } of wanted.sort((a, b) => a.far - b.far)) this.#ask(key, x, y).catch(failed);
  }

  async #ask(key, x, y) {
    const [width, height] = this.about.size;
    const rect = [x * TILE, y * TILE, Math.min(TILE, width - x * TILE), Math.min(TILE, height - y * TILE)];
    const tile = { control: new AbortController(), image: null };
    this.#tiles.set(key, tile);
    try {
      const { image } = await render({ ...this.asked(), place: `${TAB}:${this.name}:${key}`, rect, format: "png" }, tile.control.signal);
      if (this.#tiles.get(key) !== tile) return;
      image.className = "tile";
      image.alt = "";
      image.draggable = false;
      const percent = (v, of) => `${(100 * v) / of}%`;
      image.style.cssText = `left:${percent(rect[0], width)};top:${percent(rect[1], height)};width:${percent(rect[2], width)};height:${percent(rect[3], height)}`;
      tile.image = image;
      this.element.append(image);
      this.element.dispatchEvent(new CustomEvent("tile", { bubbles: true }));
    } catch (error) {
      if (this.#tiles.get(key) === tile) this.#tiles.delete(key);
      throw error;
    }
  }

  #drop(key, tile) {
    tile.control.abort();
    tile.image?.remove();
    this.#tiles.delete(key);
  }

  #dropTiles() {
    for (const [key, tile] of [...this.#tiles]) this.#drop(key, tile);
  }

  noTiles() {
    this.#dropTiles();
  }

  clear() {
    this.#busy?.abort();
    this.#dropTiles();
    this.#whole?.remove();
    this.#whole = null;
    this.about = null;
  }
}
