// The histogram of a view, and how much of it is at an end.

import { h } from "./elements.js";

const COLOURS = ["#e5484d", "#46a758", "#5b8def"];
const NAMES = ["red", "green", "blue"];
const [WIDTH, HEIGHT] = [256, 96];

export class Histogram {
  constructor() {
    const scale = 2;
    this.canvas = h("canvas", { width: WIDTH * scale, height: HEIGHT * scale, role: "img", "aria-label": "Histogram" });
    this.black = h("span", { class: "end" });
    this.white = h("span", { class: "end" });
    this.element = h("div", { class: "histogram" }, this.canvas, h("div", { class: "ends" }, this.black, this.white));
  }

  show(tally) {
    const context = this.canvas.getContext("2d");
    const { width, height } = this.canvas;
    context.clearRect(0, 0, width, height);
    if (!tally) {
      this.black.textContent = this.white.textContent = "";
      return;
    }
    context.globalCompositeOperation = "lighter";
    tally.bins.forEach((bins, c) => {
      context.beginPath();
      context.moveTo(0, height);
      bins.forEach((v, i) => context.lineTo(((i + 0.5) / bins.length) * width, height - (v / 255) * (height - 4)));
      context.lineTo(width, height);
      context.fillStyle = COLOURS[c];
      context.globalAlpha = 0.62;
      context.fill();
    });
    context.globalAlpha = 1;
    context.globalCompositeOperation = "source-over";
    end(this.black, tally.black, "black");
    end(this.white, tally.white, "white");
  }
}

/** Which channels are at an end, and for how much of the picture. */
function end(element, shares, what) {
  const most = Math.max(...shares);
  const percent = (v) => `${(100 * v).toFixed(v < 0.001 ? 2 : 1)} %`;
  element.textContent = most > 0.00005 ? `${what} ${percent(most)}` : `no ${what}`;
  element.classList.toggle("clips", most > 0.002);
  element.title = `Clipped to ${what}: ${shares.map((v, c) => `${NAMES[c]} ${percent(v)}`).join(", ")}`;
}
