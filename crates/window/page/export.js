// Writes the picture of a file, by the same job as `darkroot develop`.

import { get, post } from "./server.js";
import { baseName, field, fill, h, Notice } from "./elements.js";

const FORMATS = [["", "As the settings say"], ["jpg", "JPEG"], ["png", "PNG"], ["tif", "TIFF"], ["webp", "WebP"], ["avif", "AVIF"], ["exr", "OpenEXR"], ["jxl", "JPEG XL"]];

/** A panel over the picture; `draft()` gives the file and its edits. */
export class ExportPanel {
  #notice = new Notice();

  constructor(draft) {
    this.format = h("select", {}, FORMATS.map(([value, text]) => h("option", { value }, text)));
    this.folder = h("select", {});
    this.name = h("input", { type: "text", spellcheck: "false" });
    this.button = h("button", { class: "first", onclick: () => this.#write(draft(), false) }, "Write picture");
    this.over = h("button", { hidden: true, onclick: () => this.#write(draft(), true) }, "Replace it");
    this.element = h("div", { class: "panel export", role: "dialog", "aria-label": "Export", hidden: true },
      h("h2", {}, "Export"),
      field("Format", this.format),
      field("Folder", this.folder),
      field("Name", this.name, "Without the ending, which the format gives"),
      this.#notice.element,
      h("div", { class: "buttons" }, h("button", { onclick: () => this.close() }, "Close"), this.over, this.button));
    this.element.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Escape") this.close();
    });
  }

  async open(draft) {
    this.#notice.clear();
    this.over.hidden = true;
    this.element.hidden = false;
    const name = baseName(draft.file);
    this.name.value = name.replace(/\.[^.]*$/, "");
    fill(this.folder, h("option", { value: "" }, "Beside the photograph"));
    this.button.focus();
    try {
      for (const root of await get("folders")) {
        this.folder.append(h("option", { value: root.folder }, root.shown));
        for (const one of await get("folders", { folder: root.folder })) this.folder.append(h("option", { value: one.folder }, `${root.shown}/${one.shown}`));
      }
    } catch (error) {
      this.#notice.fault(error);
    }
  }

  close() {
    this.element.hidden = true;
  }

  async #write(draft, overwrite) {
    this.button.disabled = this.over.disabled = true;
    this.over.hidden = true;
    this.#notice.say("The picture is being developed …");
    const order = { file: draft.file, edits: draft.edits, overwrite, name: this.name.value };
    if (this.folder.value) order.folder = this.folder.value;
    if (this.format.value) order.format = this.format.value;
    try {
      const report = await post("export", order);
      this.#notice.say(`${report.output} is written: ${report.width} x ${report.height}, ${report.space}, ${report.bits} bits, ${report.seconds.toFixed(1)} s.`);
    } catch (error) {
      this.#notice.fault(error);
      this.over.hidden = error.status !== 409;
    } finally {
      this.button.disabled = this.over.disabled = false;
    }
  }
}
