// The files that were opened, what is known of them, and which are chosen.

import { get, post } from "./server.js";
import { baseName } from "./elements.js";

const AT_ONCE = 12;
/** Pictures that are seen come before what is known of files, milliseconds. */
const HEAD_START = 250;

class Files extends EventTarget {
  /** Every file: { file, size, modified }. */
  all = [];
  faults = [];
  /** By name: what the head of a file and its sidecar say. */
  facts = new Map();
  /** By name: "done" or "failed". */
  states = new Map();
  chosen = new Set();
  /** Files in the order in which they are shown. */
  shown = [];
  current = null;
  #wanted = [];
  #reading = false;

  async load() {
    const listed = await get("files");
    this.all = listed.files;
    this.faults = listed.faults;
    const there = new Set(this.all.map((one) => one.file));
    for (const file of [...this.chosen]) if (!there.has(file)) this.chosen.delete(file);
    this.#changed();
    setTimeout(() => this.loadStates().catch(() => {}), HEAD_START);
    this.read(this.all.map((one) => one.file));
  }

  async loadStates() {
    this.states = new Map(Object.entries(await get("states")));
    this.#changed();
  }

  /** Reads what is known of files: these first, the rest later. */
  read(files) {
    const known = new Set(files);
    this.#wanted = [...files.filter((file) => !this.facts.has(file)), ...this.#wanted.filter((file) => !known.has(file))];
    this.#readOn();
  }

  /** What is known of a file may be another now. */
  again(files) {
    for (const file of files) this.facts.delete(file);
    this.read(files);
  }

  async #readOn() {
    if (this.#reading) return;
    this.#reading = true;
    try {
      await new Promise((done) => setTimeout(done, HEAD_START));
      while (this.#wanted.length) {
        const files = this.#wanted.splice(0, AT_ONCE);
        const facts = await post("facts", { files });
        files.forEach((file, i) => this.facts.set(file, facts[i]));
        this.#changed();
      }
    } catch {
      // The page says that the server is gone; what is wanted is read when it is back.
    } finally {
      this.#reading = false;
    }
  }

  #changed() {
    this.dispatchEvent(new Event("change"));
  }

  /** What a person asks to see, in order. */
  arrange({ text, sort, down, camera, stars, state }) {
    const words = text.toLowerCase().split(/\s+/).filter(Boolean);
    const fits = ({ file }) => {
      const facts = this.facts.get(file);
      const name = file.slice(file.indexOf("/") + 1).toLowerCase();
      return (
        words.every((word) => name.includes(word)) &&
        (!camera || facts?.camera === camera) &&
        (!stars || (facts?.stars ?? 0) >= stars) &&
        this.#hasState(file, facts, state)
      );
    };
    const value = SORTS[sort];
    const keyed = this.all.filter(fits).map((one) => ({ one, key: value(one, this.facts.get(one.file)) }));
    const order = down ? -1 : 1;
    keyed.sort((a, b) => order * compare(a.key, b.key) || compare(a.one.file, b.one.file));
    this.shown = keyed.map(({ one }) => one);
  }

  #hasState(file, facts, state) {
    switch (state) {
      case "edited":
        return facts?.edited ?? false;
      case "unedited":
        return facts ? !facts.edited : false;
      case "done":
      case "failed":
        return this.states.get(file) === state;
      case "fault":
        return Boolean(facts?.fault ?? facts?.settings_fault);
      default:
        return true;
    }
  }

  cameras() {
    const names = new Set([...this.facts.values()].map((facts) => facts.camera).filter(Boolean));
    return [...names].sort();
  }

  async rate(files, stars) {
    const told = await post("stars", { files, stars });
    const failed = new Set(told.faults.map((fault) => fault.file));
    for (const file of files) {
      const facts = this.facts.get(file);
      if (facts && !failed.has(file)) Object.assign(facts, { stars, edited: true });
    }
    this.#changed();
    return told.faults;
  }
}

const names = new Intl.Collator(undefined, { numeric: true });

function compare(a, b) {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return names.compare(String(a), String(b));
}

/** What files are ordered by; what is not known stands at the beginning. */
export const SORTS = {
  name: ({ file }) => baseName(file),
  folder: ({ file }) => file,
  date: ({ modified }, facts) => facts?.date ?? new Date(modified).toISOString().replaceAll("-", ":"),
  camera: (_, facts) => facts?.camera ?? "",
  iso: (_, facts) => facts?.iso ?? 0,
  stars: (_, facts) => facts?.stars ?? 0,
  size: ({ size }) => size,
};

export const files = new Files();
