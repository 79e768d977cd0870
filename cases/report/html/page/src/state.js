// What is looked at, as one object, and the same in the address behind the "#", so that a view can be sent on.

// In a site that `rigor site` wrote: the addresses of its front page and of the cases before and after this one. Null in
// a report.
export const site = JSON.parse(document.getElementById("rigor-site")?.textContent ?? "null");

const listeners = new Set();
export const state = {
  case: "", // id; "" is the first page
  dt: "", // as written
  trial: "", // the name of the trial that is played; "": the first
  engines: null, // names that are shown; null: the choice the page makes
  time: 0, // s, of the playback and the plots' cursor
  show: "main", // what the matrix shows
  tolerance: 1e-3, // m or rad
  family: "", // of cases; "": all
  sort: "name", // of the matrix: name, error, cost
  verdict: "", // rows with this kind of verdict: bad, drift, good; "": any
  filter: "", // words in names of cases and engines
  layout: "overlay",
  log: true,
  zoom: null, // [from, to] in s
};
const defaults = { ...state };

export function set(changes, { push = false } = {}) {
  const changed = Object.keys(changes).filter((key) => state[key] !== changes[key]);
  if (!changed.length) return;
  Object.assign(state, changes);
  writeAddress(push);
  for (const listener of [...listeners]) listener(new Set(changed));
}

// Shows a case from its start, with the named engines, or those that the page chooses.
export const openCase = (id, changes = {}) =>
  set({ case: id, time: 0, zoom: null, trial: "", engines: null, ...changes }, { push: true });

// The address of the list of all cases, and the way to it.
export const addressOfAll = () => site?.all ?? address({ case: "" });
export const openAll = () => (site ? location.assign(site.all) : set({ case: "", time: 0, zoom: null }, { push: true }));

export function onChange(listener) {
  listeners.add(listener);
  return () => listeners.delete(listener);
}

// The address of the present view, some of it changed.
export function address(changes = {}) {
  const view = { ...state, ...changes };
  const query = new URLSearchParams();
  if (view.dt !== defaults.dt) query.set("dt", view.dt);
  if (view.show !== defaults.show) query.set("show", view.show);
  if (view.tolerance !== defaults.tolerance) query.set("tolerance", view.tolerance);
  for (const key of ["family", "sort", "verdict", "filter"]) if (view[key] !== defaults[key]) query.set(key, view[key]);
  if (view.case) {
    if (view.engines) query.set("engines", [...view.engines].join("~"));
    if (view.trial !== defaults.trial) query.set("trial", view.trial);
    if (view.time > 0) query.set("t", Number(view.time.toFixed(4)));
    if (view.layout !== defaults.layout) query.set("layout", view.layout);
    if (!view.log) query.set("log", "0");
    if (view.zoom) query.set("zoom", view.zoom.map((t) => Number(t.toFixed(4))).join("~"));
  }
  const text = query.toString().replaceAll("%2F", "/").replaceAll("%3A", ":").replaceAll("%40", "@");
  return `#/${encodeURIComponent(view.case).replaceAll("%2F", "/")}${text ? "?" + text : ""}`;
}

let pending = 0;
function writeAddress(push) {
  if (push) {
    clearTimeout(pending), (pending = 0);
    history.pushState(null, "", address());
  } else if (!pending) {
    // Browsers bear only so many changes of the address in a second, and playback makes sixty.
    pending = setTimeout(() => {
      pending = 0;
      if (address() !== location.hash) history.replaceState(null, "", address());
    }, 300);
  }
}

let onlyCase = "";
function fromAddress() {
  const [path, query = ""] = location.hash.replace(/^#\/?/, "").split("?");
  const given = new URLSearchParams(query);
  const number = (text, otherwise) =>
    text !== null && text !== "" && Number.isFinite(Number(text)) ? Number(text) : otherwise;
  const zoom = given.get("zoom")?.split("~").map(Number) ?? [];
  let id = path || onlyCase;
  try {
    if (path) id = decodeURIComponent(path);
  } catch {
    /* taken as it stands */
  }
  return {
    case: id,
    dt: given.get("dt") ?? "",
    trial: given.get("trial") ?? "",
    engines: given.has("engines") ? new Set(given.get("engines").split("~").filter(Boolean)) : null,
    time: Math.max(0, number(given.get("t"), 0)),
    show: given.get("show") ?? "main",
    tolerance: Math.abs(number(given.get("tolerance"), 1e-3)) || 1e-3,
    family: given.get("family") ?? "",
    sort: ["error", "cost"].includes(given.get("sort")) ? given.get("sort") : "name",
    verdict: ["bad", "drift", "good"].includes(given.get("verdict")) ? given.get("verdict") : "",
    filter: (given.get("filter") ?? "").toLowerCase(),
    layout: given.get("layout") === "side" ? "side" : "overlay",
    log: given.get("log") !== "0",
    zoom: zoom.length === 2 && zoom[1] > zoom[0] ? zoom : null,
  };
}

// `only`: the id of the case where there is one alone, else "".
export function followAddress(only = "") {
  onlyCase = only;
  Object.assign(state, fromAddress());
  window.addEventListener("popstate", () => {
    clearTimeout(pending), (pending = 0);
    const now = fromAddress();
    const changed = new Set(Object.keys(now).filter((key) => String(now[key]) !== String(state[key])));
    Object.assign(state, now);
    for (const listener of [...listeners]) listener(changed);
  });
}
