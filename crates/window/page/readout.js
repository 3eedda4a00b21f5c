// What the spot under the pointer is: as the camera saw it, as light, and as it is shown.

import { GAMUT, post } from "./server.js";
import { fill, h, later, newestOnly } from "./elements.js";

/** How long the pointer rests before it is asked for, milliseconds. */
const REST = 60;

/** `asked()` gives the file and its edits, or `null` where nothing is to be read. */
export class Readout {
  constructor(picture, asked) {
    this.element = h("dl", { class: "spot", "aria-label": "Spot" });
    const measure = newestOnly(async (place) => {
      const [x, y] = place.map(Math.floor);
      const wanted = asked();
      if (!wanted) return this.#show(null);
      // Where there is no picture, there is nothing to read; the picture itself says why.
      const spot = await post("spot", { ...wanted, x, y, gamut: GAMUT }).catch(() => null);
      this.#show(spot, place);
    });
    const soon = later(REST, (event) => {
      const place = asked() && picture.at(event);
      if (place) measure(place);
    });
    picture.element.addEventListener("pointermove", (event) => { if (event.buttons === 0) soon(event); });
    picture.element.addEventListener("pointerleave", () => this.#show(null));
    this.#show(null);
  }

  #show(spot, place) {
    const numbers = (values, digits) => values.map((v) => v.toFixed(digits)).join("  ");
    const rows = [
      ["Camera RGB", spot && numbers(spot.camera, 4)],
      ["XYZ (D50)", spot && numbers(spot.xyz, 4)],
      ["Lab (D50)", spot && numbers(spot.lab, 1)],
      ["Output", spot && numbers(spot.output, 0)],
      ["Place", spot && place.map(Math.floor).join(", ")],
    ];
    fill(this.element, rows.flatMap(([name, value]) => [h("dt", {}, name), h("dd", {}, value ?? "–")]));
  }
}
