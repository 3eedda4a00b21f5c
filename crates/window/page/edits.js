// What a person changed of a file's settings, until it is saved: with undo and redo. A sidecar is written by `save` alone.

import { get, put } from "./server.js";

const drafts = new Map();

/** Settings that were copied from a file. */
export const clipboard = { from: "", edits: {}, names: [] };

/** Whether a file has changes that are not saved. */
export const hasDraft = (file) => drafts.get(file)?.isDirty ?? false;

/** Edits of a file that are not saved; `undefined` where its sidecar has them all. */
export const unsaved = (file) => (hasDraft(file) ? drafts.get(file).edits : undefined);

/** The changes of a file, begun from what is saved where there are none yet. */
export async function draft(file) {
  const known = drafts.get(file);
  if (known?.isDirty) return known;
  const fresh = new Draft(file);
  await fresh.load();
  drafts.set(file, fresh);
  return fresh;
}

/** Lets go of what was known of files whose sidecars were written elsewhere, unless they have changes here. */
export function forget(files) {
  for (const file of files) if (!hasDraft(file)) drafts.delete(file);
}

addEventListener("beforeunload", (event) => {
  if ([...drafts.values()].some((one) => one.isDirty)) event.preventDefault();
});

/** Events: `change` whenever the edits do, `commit` when that is for good. */
class Draft extends EventTarget {
  /** Without the sidecar: text and origin by name. */
  base = {};
  /** Text by name. */
  edits = {};
  version = "";
  #saved = {};
  #steps = [{}];
  #at = 0;

  constructor(file) {
    super();
    this.file = file;
  }

  async load() {
    this.#take(await get("edits", { file: this.file }));
    this.edits = { ...this.#saved };
    this.#steps = [this.edits];
    this.#at = 0;
    this.#tell("commit");
  }

  #take({ base, edits, version }) {
    this.base = base;
    this.#saved = edits;
    this.version = version;
  }

  get isDirty() {
    return !same(this.edits, this.#saved);
  }

  get canUndo() {
    return this.#at > 0;
  }

  get canRedo() {
    return this.#at + 1 < this.#steps.length;
  }

  /** What holds for a setting. */
  text(name) {
    return this.edits[name] ?? this.base[name]?.text ?? "";
  }

  /** Changes settings; `null` takes an edit away. More of the same may follow until `commit`. */
  set(changes) {
    const edits = { ...this.edits };
    for (const [name, text] of Object.entries(changes)) {
      if (text === null || text === this.base[name]?.text) delete edits[name];
      else edits[name] = text;
    }
    this.edits = edits;
    this.#tell("change");
  }

  /** What was changed until now is one step back. */
  commit() {
    if (same(this.edits, this.#steps[this.#at])) return;
    this.#steps = [...this.#steps.slice(0, this.#at + 1), this.edits];
    this.#at += 1;
    this.#tell("commit");
  }

  undo() {
    if (!same(this.edits, this.#steps[this.#at])) this.commit();
    this.#go(-1);
  }

  redo() {
    this.#go(1);
  }

  #go(by) {
    if (!this.#steps[this.#at + by]) return;
    this.#at += by;
    this.edits = this.#steps[this.#at];
    this.#tell("change");
    this.#tell("commit");
  }

  /** Writes the sidecar; over whatever another wrote meanwhile, if `anyway`. */
  async save(anyway = false) {
    this.commit();
    this.#take(await put("edits", { file: this.file, edits: this.edits, version: anyway ? null : this.version }));
    this.edits = { ...this.#saved };
    this.#steps[this.#at] = this.edits;
    this.#tell("commit");
  }

  #tell(event) {
    this.dispatchEvent(new Event(event));
  }
}

function same(a, b) {
  const names = Object.keys(a);
  return names.length === Object.keys(b).length && names.every((name) => a[name] === b[name]);
}
