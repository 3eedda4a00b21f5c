// Requests to the server. The page's own address carries the token, and every address here is relative to it.

const API = new URL("api/v1/", document.baseURI);

/** What went wrong, in one sentence; `status` is that of HTTP, 0 where there was no answer. */
export class Fault extends Error {
  constructor(status, words) {
    super(words);
    this.status = status;
  }
}

const listeners = new Set();

/** Calls `hear(true)` when the server answers again, `hear(false)` when it is gone. */
export function onConnection(hear) {
  listeners.add(hear);
}

function tell(there) {
  for (const hear of listeners) hear(there);
}

async function ask(method, path, { query, body, signal } = {}) {
  const url = new URL(path, API);
  for (const [name, value] of Object.entries(query ?? {})) url.searchParams.set(name, value);
  const headers = body === undefined ? {} : { "content-type": "application/json" };
  let answer;
  try {
    answer = await fetch(url, { method, headers, body: body && JSON.stringify(body), signal });
  } catch (error) {
    if (error.name === "AbortError") throw error;
    tell(false);
    throw new Fault(0, "The server does not answer.");
  }
  tell(answer.status !== 403);
  if (answer.ok) return answer;
  const told = await answer.json().catch(() => ({}));
  throw new Fault(answer.status, told.error ?? `The server answered ${answer.status}.`);
}

export const get = async (path, query, signal) => (await ask("GET", path, { query, signal })).json();
export const post = async (path, body, signal) => (await ask("POST", path, { body, signal })).json();
export const put = async (path, body) => (await ask("PUT", path, { body })).json();

/** Address of a picture or page of the server. */
export function address(path, query) {
  const url = new URL(path, API);
  for (const [name, value] of Object.entries(query ?? {})) url.searchParams.set(name, value);
  return url.href;
}

/** Renders a view: the picture, decoded and ready to be shown, and what is to be said of it. */
export async function render(wanted, signal) {
  const answer = await ask("POST", "render", { body: { gamut: GAMUT, ...wanted }, signal });
  const about = JSON.parse(answer.headers.get("darkroot-view") ?? "{}");
  const image = new Image();
  image.src = URL.createObjectURL(await answer.blob());
  try {
    await image.decode();
  } finally {
    // What is decoded no longer needs its bytes.
    URL.revokeObjectURL(image.src);
  }
  return { image, about };
}

/** What the screen shows. */
export const GAMUT = matchMedia("(color-gamut: p3)").matches ? "display-p3" : "srgb";

/** Tells this tab from others. */
export const TAB = crypto.getRandomValues(new Uint32Array(2)).join("-");
