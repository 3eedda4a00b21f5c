// The views and the way between them.

import { get, onConnection } from "./server.js";
import * as sheet from "./sheet.js";
import * as develop from "./develop.js";
import * as chart from "./chart.js";
import * as batch from "./batch.js";
import { h } from "./elements.js";
import { forget } from "./edits.js";

const views = { sheet, develop, chart, batch };
const sections = Object.fromEntries(Object.keys(views).map((name) => [name, document.getElementById(name)]));

/** What views ask of each other. */
const routes = {
  sheet: () => { location.hash = "sheet"; },
  develop: (file) => { location.hash = `develop=${encodeURIComponent(file)}`; },
  batch: (files, settings) => {
    handed = { files, settings };
    if (location.hash === "#batch") route();
    else location.hash = "batch";
  },
  /** The address says what is shown, without a step back. */
  place: (view, file) => { if (file) history.replaceState(null, "", `#${view}=${encodeURIComponent(file)}`); },
  /** Sidecars of these files were written. */
  changed: (files) => {
    forget(files);
    develop.outdated(files);
  },
};
let handed = {};

function route() {
  const [, name, file] = /^#(\w+)(?:=(.*))?$/.exec(location.hash) ?? [];
  const view = name in views ? name : "sheet";
  for (const [other, section] of Object.entries(sections)) section.hidden = other !== view;
  for (const link of document.querySelectorAll("nav a")) link.toggleAttribute("aria-current", link.dataset.view === view);
  document.title = { sheet: "Darkroot", develop: "Develop – Darkroot", chart: "Chart – Darkroot", batch: "Batch – Darkroot" }[view];
  if (view === "batch") {
    batch.show(handed.files, handed.settings);
    handed = {};
  } else {
    views[view].show(file ? decodeURIComponent(file) : undefined);
  }
}

const lost = document.getElementById("lost");
onConnection((there) => {
  lost.hidden = there;
  lost.textContent = "The program behind this page has ended, or it was started again: open the address that `darkroot open` prints. What is not saved stays here while this page is open.";
});

async function start() {
  const [status, table] = await Promise.all([get("status"), get("settings")]);
  const place = document.getElementById("place");
  place.append(h("bdi", {}, status.folders.join(", ")));
  place.title = status.folders.join("\n");
  sheet.build(sections.sheet, routes);
  await Promise.all([develop.build(sections.develop, routes, table), chart.build(sections.chart, routes, table)]);
  batch.build(sections.batch, routes);
  addEventListener("hashchange", route);
  route();
  // Every view goes by what is in the folders.
  if (sections.sheet.hidden) sheet.load();
}

start().catch((error) => {
  lost.hidden = false;
  lost.textContent = error.message;
});
