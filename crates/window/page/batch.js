// Batches: begun here or watched, with what failed first.

import { address, get, post } from "./server.js";
import { duration, field, fill, h, Notice } from "./elements.js";
import { files } from "./files.js";

let root, go, chosen, stream;
const notice = new Notice();
const parts = {};
/** Settings that the next batch gets. */
let settings = {};
let current = null;

export function build(element, routes) {
  root = element;
  go = routes;
  parts.what = h("select", {});
  parts.root = h("select", { "aria-label": "Folder that was opened" });
  parts.out = h("input", { type: "text", value: "pictures", spellcheck: "false", "aria-label": "Folder of the pictures" });
  parts.format = h("select", {}, [["", "As the settings say"], ["jpeg", "JPEG"], ["png", "PNG"], ["tiff", "TIFF"], ["webp", "WebP"], ["avif", "AVIF"], ["exr", "OpenEXR"], ["jxl", "JPEG XL"]].map(([value, text]) => h("option", { value }, text)));
  parts.chart = h("select", {}, [["", "As the settings say"], ["auto", "From a shot of a chart in each folder"]].map(([value, text]) => h("option", { value }, text)));
  parts.redo = h("input", { type: "checkbox", class: "switch" });
  parts.over = h("input", { type: "checkbox", class: "switch" });
  parts.sheet = h("input", { type: "checkbox", class: "switch" });
  parts.collision = h("select", {});
  parts.collisions = field("Files of one name", parts.collision, "RAW and DNG of one shot, for example: both would become one picture");
  parts.profile = h("p", { class: "told", hidden: true });
  parts.watch = h("div", { class: "journals" });
  parts.list = h("ul", { class: "batches" });
  parts.detail = h("div", { class: "detail" });
  fill(root,
    h("div", { class: "halves" },
      h("div", { class: "form" },
        h("h2", {}, "Develop a folder"),
        field("Photographs", parts.what),
        field("Pictures go to", h("span", { class: "path-field" }, parts.root, h("span", {}, "/"), parts.out), "A folder below the one that was opened; it is made if it is missing"),
        field("Format", parts.format),
        field("Colours", parts.chart),
        parts.profile,
        parts.collisions,
        field("Everything again, also what is done", parts.redo),
        field("Replace pictures that are not from a batch", parts.over),
        field("Write a contact sheet", parts.sheet, "sheet.html beside the pictures"),
        notice.element,
        h("div", { class: "buttons" }, h("button", { class: "first", onclick: start }, "Start")),
        h("h2", {}, "Watch a batch"),
        h("p", { class: "help" }, "Folders in which a batch has written, also one that runs in a terminal now."),
        parts.watch,
        h("h2", {}, "Batches of this window"),
        parts.list),
      parts.detail));
}

files.addEventListener("change", () => { if (root) collisions(); });

/** Shows the view; `only` names files that are to be developed. */
export async function show(only, given) {
  if (only) chosen = only;
  if (given) settings = given;
  notice.clear();
  fill(parts.what,
    chosen?.length ? h("option", { value: "chosen" }, `${chosen.length} chosen ${chosen.length === 1 ? "photograph" : "photographs"}`) : null,
    h("option", { value: "all" }, "All that was opened, with folders in it"),
    files.chosen.size && !chosen?.length ? h("option", { value: "selection" }, `The ${files.chosen.size} chosen in the contact sheet`) : null);
  collisions();
  parts.profile.hidden = !settings.profile;
  parts.profile.textContent = settings.profile ? `With the profile ${settings.profile}` : "";
  try {
    await folders();
    await list();
  } catch (error) {
    notice.fault(error);
  }
}

let listed = null;

/** Offers what can become of files whose pictures would have one name, where there are some. */
function collisions() {
  if (files.all === listed) return;
  listed = files.all;
  const kinds = new Map();
  for (const { file } of files.all) {
    const [, stem, ending] = /^(.*)\.([^./]*)$/.exec(file.toLowerCase()) ?? [null, file, ""];
    kinds.set(stem, [...(kinds.get(stem) ?? []), ending]);
  }
  const endings = [...new Set([...kinds.values()].filter((all) => all.length > 1).flat())].sort();
  const kept = parts.collision.value;
  parts.collisions.hidden = endings.length === 0;
  fill(parts.collision, [
    ["", "Say so, and do nothing"],
    ["suffix", "All of them, with the ending in the name"],
    ["skip", "The first of them"],
    ...endings.map((ending) => [`prefer:${ending}`, `The ${ending.toUpperCase()}, where there is one`]),
  ].map(([value, text]) => h("option", { value, selected: value === kept }, text)));
}

async function folders() {
  const roots = await get("folders");
  fill(parts.root, roots.map((one) => h("option", { value: one.folder, title: one.shown }, lastOf(one.shown))));
  const found = [];
  for (const one of roots) {
    if (one.journal) found.push(one);
    for (const inner of await get("folders", { folder: one.folder })) if (inner.journal) found.push(inner);
  }
  fill(parts.watch, found.length
    ? found.map((one) => h("button", { title: one.shown, onclick: () => watch(one.folder) }, lastOf(one.shown)))
    : h("p", { class: "empty-line" }, "None yet."));
}

async function list() {
  const all = await get("batch");
  fill(parts.list, all.length
    ? all.map((one) => h("li", {}, h("button", { class: one.id === current ? "on" : "", onclick: () => follow(one.id) }, h("b", { title: one.out }, h("bdi", {}, one.out)), h("span", {}, summary(one)))))
    : h("li", { class: "empty-line" }, "None yet."));
  if (current === null && all.length) follow(all[0].id);
  else if (current === null) detail(null);
}

/** The last part of a path. */
const lastOf = (path) => path.replace(/[/\\]+$/, "").split(/[/\\]/).at(-1) || path;

const PHASES = { planning: "Looking at files", running: "At work", pausing: "Finishing what is begun", paused: "Paused", done: "Done", failed: "Not run" };

function summary(one) {
  const failed = one.failed ? `, ${one.failed} failed` : "";
  return `${PHASES[one.phase]}: ${one.done} done${failed}`;
}

function inputs() {
  if (parts.what.value === "chosen") return chosen;
  if (parts.what.value === "selection") return [...files.chosen];
  return [...parts.root.options].map((option) => option.value);
}

async function start() {
  notice.clear();
  const out = parts.out.value.trim().replace(/^\/+|\/+$/g, "");
  if (!out) return notice.fault(new Error("Name the folder that pictures go to."));
  const more = { ...settings };
  if (parts.format.value) more.format = parts.format.value;
  try {
    const begun = await post("batch", {
      inputs: inputs(), out: parts.root.value + out, settings: more, redo: parts.redo.checked, overwrite: parts.over.checked,
      chart_shot: parts.chart.value || null, on_collision: (!parts.collisions.hidden && parts.collision.value) || null, sheet: parts.sheet.checked,
    });
    follow(begun.id);
    await list();
  } catch (error) {
    notice.fault(error);
  }
}

async function watch(out) {
  try {
    const batch = await post("batch/watch", { out });
    follow(batch.id);
    await list();
  } catch (error) {
    notice.fault(error);
  }
}

/** Follows a batch until another is followed. */
function follow(id) {
  current = id;
  stream?.close();
  stream = new EventSource(address(`batch/${id}/events`));
  let ended = false;
  stream.onmessage = (event) => {
    const told = JSON.parse(event.data);
    detail(told);
    const line = parts.list.querySelector(".on span");
    if (line) line.textContent = summary(told);
    const ends = told.phase === "done" || told.phase === "failed" || told.phase === "paused";
    if (ends && !ended) {
      list().catch(() => {});
      folders().catch(() => {});
      files.loadStates().catch(() => {});
    }
    ended = ends;
  };
  stream.onerror = () => parts.detail.querySelector(".state")?.classList.add("stale");
}

addEventListener("hashchange", () => {
  if (location.hash.startsWith("#batch") || !stream) return;
  stream.close();
  stream = null;
  current = null;
});

function detail(one) {
  if (!one) {
    fill(parts.detail, h("p", { class: "empty" }, "No batch is followed. Start one at the left, or watch one that runs elsewhere."));
    return;
  }
  const ended = one.done + one.failed + one.skipped;
  const share = one.total ? ended / one.total : null;
  const facts = [
    [one.total === null ? `${one.done}` : `${one.done + one.skipped} of ${one.total}`, "developed"],
    [String(one.failed), "failed"],
    [one.rate ? one.rate.toFixed(1) : "–", "MP/s"],
    [one.phase === "running" && one.left !== null ? duration(one.left) : "–", "left"],
    [one.seconds ? duration(one.seconds) : "–", "time"],
  ];
  const act = async (what) => {
    try {
      await post(`batch/${one.id}/${what}`, {});
    } catch (error) {
      notice.fault(error);
    }
  };
  const mine = one.kind === "run";
  fill(parts.detail,
    h("div", { class: "head" },
      h("h2", { title: one.out }, h("bdi", {}, one.out)),
      h("span", { class: "state", "data-phase": one.phase }, PHASES[one.phase]),
      h("span", { class: "space" }),
      one.sheet && h("a", { class: "button", href: address(`batch/${one.id}/sheet`), target: "_blank", rel: "noreferrer" }, "Contact sheet"),
      mine && (one.phase === "running" || one.phase === "planning") && h("button", { onclick: () => act("pause") }, "Pause"),
      mine && (one.phase === "paused" || one.phase === "failed" || one.phase === "done") && h("button", { onclick: () => act("resume").then(() => follow(one.id)) }, one.phase === "paused" ? "Go on" : "Look for what is left")),
    h("progress", { max: 1, "aria-label": "Progress", value: share ?? (one.phase === "running" ? undefined : 1), class: share === null ? "open" : "" }),
    h("dl", { class: "figures" }, facts.map(([value, name]) => h("div", { class: name === "failed" && one.failed ? "bad" : "" }, h("dd", {}, value), h("dt", {}, name)))),
    one.skipped > 0 && h("p", { class: "help" }, `${one.skipped} were done before and are unchanged.`),
    one.notes.map((note) => h("p", { class: "notice", "data-kind": one.phase === "failed" ? "fault" : "said" }, note)),
    one.failures.length > 0 && h("section", {}, h("h3", {}, "Failed"), h("ul", { class: "failures" }, one.failures.map((failure) => h("li", {}, failure.words)))),
    one.at_work.length > 0 && h("section", {}, h("h3", {}, "At work"), h("ul", { class: "lines" }, one.at_work.map((name) => h("li", {}, name)))),
    one.recent.length > 0 && h("section", {}, h("h3", {}, "Developed"), h("table", { class: "lines" }, h("tbody", {}, one.recent.map((done) => h("tr", {}, h("td", {}, done.input), h("td", {}, done.output), h("td", {}, `${done.seconds.toFixed(1)} s`)))))));
}
