// What tools on the picture have in common: they take the stage, draw over the picture, and end with or without a choice.

import { post } from "./server.js";
import { Notice, svg } from "./elements.js";

/** Where the arrow keys lead. */
export const ARROWS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/**
 * Takes the stage from `begin` until `end`; `done(changes)` gets the settings that were chosen. A tool has `bar`, an element;
 * `lay()`, which draws; `chosen()`, the settings that it asks for; `undone()`, those that put back what it changed meanwhile.
 */
export class Tool {
  #done;
  #lay;
  #ended = false;

  constructor(picture, draft, done, name) {
    /** For what is wrong with a choice; stands in the bar. */
    this.notice = new Notice();
    this.picture = picture;
    this.draft = draft;
    this.#done = done;
    this.overlay = svg("svg", { class: `overlay ${name}` });
    this.#lay = () => this.lay();
    picture.addEventListener("view", this.#lay);
  }

  begin() {
    this.picture.busy = true;
    this.picture.element.append(this.overlay);
  }

  /** Ends it, with or without what was chosen. A choice that cannot be leaves it there, and says so. */
  async end(yes) {
    if (this.#ended) return;
    this.#ended = true;
    let changes;
    try {
      changes = yes ? await this.chosen() : this.undone();
    } catch (error) {
      this.#ended = false;
      this.notice.fault(error);
      return;
    }
    this.picture.removeEventListener("view", this.#lay);
    this.picture.busy = false;
    this.overlay.remove();
    this.#done(changes);
  }

  /** Edits under which the picture is shown while the tool is there. */
  shown(edits) {
    return edits;
  }

  undone() {
    return {};
  }

  /** Takes its own last step back. Whether there was one. */
  undo() {
    return false;
  }

  /** Where a crop can lie under edits, and where it lies. */
  frame(edits) {
    return post("frame", { file: this.draft.file, edits });
  }
}
