// A chart on a shot: found or placed by hand, measured and judged while it is moved; a profile made of it and saved.

import { address, get, post } from "./server.js";
import { baseName, field, fill, h, later, newestOnly, Notice, shown, svg } from "./elements.js";
import { Picture } from "./picture.js";
import { files } from "./files.js";

let root, go, picture, offers, unlaid;
let file = null;
let corners = null;
let excluded = new Set();
let judged = null;
const notice = new Notice();
const saved = new Notice();
const parts = {};
const overlay = svg("svg", { class: "overlay chart" });

export async function build(element, routes, table) {
  root = element;
  go = routes;
  // Charts are found and measured where no geometry is asked for.
  const laid = table.filter((one) => one.section === "Geometry");
  unlaid = Object.fromEntries(laid.map((one) => [one.name, one.name === "lens" ? "off" : String(one.default)]));
  picture = new Picture(() => ({ file, edits: unlaid }));
  picture.element.append(overlay);
  picture.addEventListener("view", lay);
  picture.addEventListener("fault", ({ detail }) => notice.fault(detail));
  parts.file = h("span", { class: "file-name" });
  parts.chart = h("select", { onchange: () => { excluded.clear(); find(); } });
  parts.reference = h("input", { type: "text", spellcheck: "false", placeholder: "That of the chart", onchange: judge });
  parts.lights = h("datalist", { id: "lights" });
  parts.light = h("input", { type: "text", spellcheck: "false", placeholder: "D50, A, 5200K …", list: null, onchange: marks });
  parts.light.setAttribute("list", "lights");
  parts.accept = h("input", { type: "checkbox", class: "switch" });
  parts.hand = h("button", { onclick: byHand }, "Place by hand");
  parts.turn = h("button", { onclick: turn, title: "The next corner becomes that of patch 1" }, "Turn a quarter");
  parts.gates = h("ul", { class: "gates" });
  parts.notes = h("ul", { class: "notes" });
  parts.out = h("p", { class: "told" });
  parts.fit = h("button", { class: "first", onclick: fit }, "Make profile");
  parts.made = h("div", { class: "made" });
  parts.empty = h("p", { class: "empty" }, "Choose a shot of a chart: mark it in the contact sheet and come here, or open it in Develop first.");
  parts.report = h("div", { class: "report", hidden: true });
  fill(root,
    h("div", { class: "desk" },
      h("div", { class: "middle" },
        h("div", { class: "tools" }, parts.file, h("span", { class: "space" }), h("button", { onclick: () => find() }, "Find"), parts.hand, parts.turn),
        notice.element,
        h("div", { class: "stage-frame" }, picture.element, parts.empty, parts.report)),
      h("aside", { class: "side", "aria-label": "Chart" },
        field("Chart", parts.chart),
        field("Reference", parts.reference, "A built-in reference, or the whole path of a file in a folder that was opened"),
        field("Light of the shot", h("span", { class: "with-list" }, parts.light, parts.lights), "D50, A, FL11, 5200K, x,y, or the whole path of a spectrum's file"),
        h("h2", {}, "Checks"),
        parts.gates,
        parts.out,
        field("Use the shot even if a check fails", parts.accept),
        h("div", { class: "buttons" }, parts.fit),
        saved.element,
        parts.made,
        parts.notes)));
  offers = await get("charts");
  fill(parts.chart, offers.charts.map((chart) => h("option", { value: chart.name }, chart.title)));
  fill(parts.lights, offers.lights.map((name) => h("option", { value: name })));
}

export async function show(name) {
  const next = name ?? file ?? files.current;
  parts.empty.hidden = Boolean(next);
  if (!next) return marks();
  if (!name) go.place("chart", next);
  if (next === file) {
    picture.update();
    return;
  }
  file = files.current = next;
  parts.file.textContent = baseName(file);
  parts.file.title = shown(file);
  corners = judged = null;
  excluded.clear();
  fill(parts.made);
  parts.report.hidden = true;
  picture.reset();
  saved.clear();
  lay();
  picture.update();
  await find(true);
}

const request = () => ({
  file, chart: parts.chart.value, reference: parts.reference.value || null, corners, exclude: [...excluded],
});

/** Looks for the chart that is chosen; for any, at first. */
async function find(any = false) {
  if (!file) return;
  notice.say("Looking for the chart …");
  const of = file;
  try {
    const { found, rejected } = await post("chart/find", { file, chart: any ? null : parts.chart.value });
    if (of !== file) return;
    const best = found[0];
    if (!best) {
      corners = judged = null;
      notice.fault(new Error(`No chart was found${rejected ? `: ${rejected.reason}` : ""}. Place it by hand.`));
      gates();
      lay();
      return;
    }
    notice.clear();
    if (any && [...parts.chart.options].some((option) => option.value === best.chart)) parts.chart.value = best.chart;
    corners = best.corners;
    lay();
    judge();
  } catch (error) {
    notice.fault(error);
  }
}

/** A chart in the middle of what is seen, to be dragged into place. */
function byHand() {
  if (!picture.size) return;
  const [width, height] = picture.size;
  const { columns, rows } = offers.charts.find((one) => one.name === parts.chart.value) ?? { columns: 6, rows: 4 };
  const w = Math.min(width * 0.6, (height * 0.6 * columns) / rows);
  const hgt = (w * rows) / columns;
  const [x, y] = [(width - w) / 2, (height - hgt) / 2];
  corners = [[x, y], [x + w, y], [x + w, y + hgt], [x, y + hgt]];
  notice.clear();
  lay();
  judge();
}

function turn() {
  if (!corners) return;
  corners = [...corners.slice(1), corners[0]];
  lay();
  judge();
}

const measured = newestOnly(async () => {
  try {
    judged = await post("chart/judge", request());
    notice.clear();
  } catch (error) {
    judged = null;
    notice.fault(error);
  }
  gates();
  lay();
});

function judge() {
  if (file && corners) measured();
}

const soon = later(30, judge);

function gates() {
  marks();
  fill(parts.gates, judged
    ? judged.gates.map((gate) => h("li", { "data-verdict": gate.verdict, title: gate.verdict === "good" ? "" : gate.advice }, h("b", {}, gate.name), h("span", {}, gate.words), gate.verdict !== "good" && h("small", {}, gate.advice)))
    : h("li", { class: "empty-line" }, "They are shown when a chart is on the picture."));
  parts.out.textContent = excluded.size ? `Left out: ${[...excluded].join(", ")}` : "Click a patch to leave it out.";
  fill(parts.notes, (judged?.notes ?? []).map((note) => h("li", {}, note)));
}

function marks() {
  parts.fit.disabled = !corners || !parts.light.value.trim();
  parts.fit.title = parts.fit.disabled ? "Name the light of the shot and place the chart first" : "";
  parts.turn.disabled = !corners;
  parts.hand.disabled = !file;
}

/** Draws what is known over the picture. */
function lay() {
  if (!corners || !picture.size) return fill(overlay);
  const { left, top } = picture.sheet.style;
  const origin = [parseFloat(left), parseFloat(top)];
  // The middle of the first pixel is at 0.
  const at = (place) => place.map((v, i) => origin[i] + (v + 0.5) * picture.zoom);
  const points = (quad) => quad.map((place) => at(place).map((v) => v.toFixed(1)).join(",")).join(" ");
  const children = [svg("polygon", { class: "outline", points: points(corners) })];
  (judged?.patches ?? []).forEach((patch, i) => {
    const out = excluded.has(patch.name);
    const kind = out ? "out" : patch.clipped ? "clipped" : "";
    const [cx, cy] = [0, 1].map((axis) => patch.window.reduce((sum, place) => sum + at(place)[axis], 0) / 4);
    const wide = Math.hypot(...[0, 1].map((axis) => at(patch.window[1])[axis] - at(patch.window[0])[axis]));
    const group = svg("g", { class: `patch ${kind}`, onclick: () => toggle(patch.name) },
      svg("title", {}, `${i + 1}: ${patch.name}${patch.excluded ? ` (${patch.excluded})` : ""}, camera RGB ${patch.rgb.map((v) => v.toFixed(3)).join(" ")}`),
      svg("polygon", { points: points(patch.outline ?? patch.window), class: "whole" }),
      svg("polygon", { points: points(patch.window), class: "window" }));
    if (wide > 14) group.append(svg("text", { x: cx, y: cy }, String(i + 1)));
    children.push(group);
  });
  corners.forEach((corner, i) => {
    const [cx, cy] = at(corner);
    const handle = svg("circle", { class: `handle ${i === 0 ? "first" : ""}`, cx, cy, r: 8, tabindex: "0", "aria-label": `Corner ${i + 1}` });
    handle.addEventListener("pointerdown", (event) => drag(event, i));
    handle.addEventListener("keydown", (event) => nudge(event, i));
    children.push(handle);
  });
  const kept = document.activeElement?.getAttribute?.("aria-label");
  fill(overlay, children);
  if (kept?.startsWith("Corner")) overlay.querySelector(`[aria-label="${kept}"]`)?.focus();
}

function toggle(name) {
  if (!excluded.delete(name)) excluded.add(name);
  judge();
}

function drag(event, i) {
  event.preventDefault();
  event.stopPropagation();
  const from = [event.clientX, event.clientY];
  const start = corners[i];
  const move = (e) => {
    corners = corners.map((corner, j) => (j === i ? [start[0] + (e.clientX - from[0]) / picture.zoom, start[1] + (e.clientY - from[1]) / picture.zoom] : corner));
    lay();
    soon();
  };
  const end = () => {
    removeEventListener("pointermove", move);
    judge();
  };
  addEventListener("pointermove", move);
  addEventListener("pointerup", end, { once: true });
}

function nudge(event, i) {
  const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[event.key];
  if (!step) return;
  event.preventDefault();
  const far = event.shiftKey ? 20 : 2;
  corners = corners.map((corner, j) => (j === i ? corner.map((v, axis) => v + step[axis] * far) : corner));
  lay();
  judge();
}

async function fit() {
  saved.say("The profile is being made …");
  parts.fit.disabled = true;
  try {
    const made = await post("chart/fit", { ...request(), light: parts.light.value.trim(), accept: parts.accept.checked });
    saved.clear();
    shows(made);
  } catch (error) {
    saved.fault(error);
  } finally {
    marks();
  }
}

function shows(made) {
  const name = h("input", { type: "text", value: made.name, spellcheck: "false" });
  const over = h("button", { hidden: true, onclick: () => save(made, name, over, true) }, "Replace it");
  const light = made.lights[0];
  const errors = light.left_out;
  fill(parts.made,
    h("h2", {}, "Profile"),
    h("p", {}, `${made.camera} under ${light.light}: ${light.model}${errors ? `, dE2000 of patches left out: mean ${errors.mean.toFixed(2)}, largest ${errors.max.toFixed(2)}` : ""}`),
    h("button", { onclick: () => report(made.id) }, "Show the report"),
    field("Name", name, "In your folder of profiles"),
    h("div", { class: "buttons" }, over, h("button", { class: "first", onclick: () => save(made, name, over, false) }, "Save profile")));
  parts.made.scrollIntoView({ block: "nearest" });
  report(made.id);
}

function report(id) {
  parts.report.hidden = false;
  fill(parts.report,
    h("div", { class: "tools" }, h("b", {}, "Report"), h("span", { class: "space" }), h("button", { onclick: () => { parts.report.hidden = true; } }, "Close")),
    h("iframe", { src: address(`chart/fit/${id}/report`), title: "Report of the profile", sandbox: "" }));
}

async function save(made, name, over, overwrite) {
  try {
    const { path, shown: where } = await post(`chart/fit/${made.id}/save`, { name: name.value.trim(), overwrite });
    over.hidden = true;
    saved.say(`${where} is saved and serves this camera from now on.`);
    if (!parts.made.querySelector(".with-it")) {
      parts.made.append(h("div", { class: "buttons with-it" }, h("button", { onclick: () => go.batch(null, { profile: path }) }, "Develop a folder with it …")));
    }
  } catch (error) {
    saved.fault(error);
    over.hidden = error.status !== 409;
  }
}
