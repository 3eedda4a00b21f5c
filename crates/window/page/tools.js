// The tools of the develop view that work on the picture itself: a grey spot, the crop, lines. One at a time.

import { post } from "./server.js";
import { fill, h, isTyping } from "./elements.js";
import { CropTool } from "./crop.js";
import { LineTool } from "./lines.js";

/** `hands` has `draft()`, `set(changes)` for what was chosen, and `fault(error)`. */
export class Tools {
  #picture;
  #hands;
  /** A `Tool`, `"pick"` or nothing. */
  #now = null;

  constructor(picture, hands) {
    this.#picture = picture;
    this.#hands = hands;
    this.place = h("div", { class: "tool-place" });
    this.buttons = {
      pick: h("button", { title: "Choose a grey spot on the picture (W)", onclick: () => this.pick(true) }, "Pick grey"),
      crop: h("button", { title: "Choose the crop on the picture (C)", onclick: () => this.crop() }, "Crop and turn"),
      lines: h("button", { title: "Draw lines along what shall be level or upright (L)", onclick: () => this.lines() }, "Straighten by lines"),
    };
    picture.addEventListener("press", ({ detail }) => this.#pressed(detail));
  }

  /** Whether the picture is shown otherwise than the edits say. */
  get holdsPicture() {
    return this.#now instanceof Object;
  }

  /** What is to be rendered while a tool is there, of what would be else. */
  asked(request) {
    return this.holdsPicture ? { ...request, edits: this.#now.shown(request.edits), uncropped: true } : { ...request, uncropped: false };
  }

  /** Ends what is there, without a choice. */
  end() {
    if (this.holdsPicture) this.#now.end(false);
    else this.pick(false);
  }

  pick(yes) {
    if (yes) this.end();
    this.#now = yes ? "pick" : null;
    this.#picture.element.classList.toggle("picking", yes);
    this.buttons.pick.classList.toggle("on", yes);
  }

  async #pressed(event) {
    const place = this.#picture.at(event);
    if (this.#now !== "pick" || !place) return;
    const [x, y] = place.map(Math.floor);
    this.pick(false);
    const { file, edits } = this.#hands.draft();
    try {
      this.#hands.set({ "white-balance": await post("balance", { file, edits, x, y }) });
    } catch (error) {
      this.#hands.fault(error);
    }
  }

  crop() {
    return this.#begin(CropTool, this.buttons.crop);
  }

  lines() {
    return this.#begin(LineTool, this.buttons.lines);
  }

  async #begin(Kind, button) {
    const draft = this.#hands.draft();
    if (!draft || this.#now instanceof Kind) return;
    this.end();
    const tool = new Kind(this.#picture, draft, (changes) => {
      this.#now = null;
      fill(this.place);
      button.classList.remove("on");
      this.#picture.reset();
      this.#hands.set(changes);
      this.#picture.update();
    });
    this.#now = tool;
    button.classList.add("on");
    fill(this.place, tool.bar);
    this.#picture.reset();
    await this.#picture.update();
    if (this.#now !== tool) return;
    try {
      await tool.begin();
    } catch (error) {
      tool.end(false);
      this.#hands.fault(error);
    }
  }

  /** A key that belongs to a tool. Whether there is one that takes it. */
  key(event) {
    if (event.ctrlKey || event.metaKey) return event.key === "z" && this.holdsPicture && this.#now.undo();
    if (event.altKey || isTyping(event)) return false;
    if (event.key === "Escape" && this.#now) this.end();
    else if (event.key === "Enter" && this.holdsPicture && !event.target.closest?.(".cancel")) this.#now.end(true);
    else if (this.holdsPicture) return false;
    else if (event.key === "w") this.pick(this.#now !== "pick");
    else if (event.key === "c") this.crop();
    else if (event.key === "l") this.lines();
    else return false;
    return true;
  }
}
