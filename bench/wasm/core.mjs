// The core's WebAssembly build as a plug-in like those of adapters/plugin/examples/npm, so that it meets the other engines
// on their ground. RIGOR_CORE_WASM names the script that emscripten wrote.
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { serve } from "./serve.mjs";

const path = process.env.RIGOR_CORE_WASM;
const core = await createRequire(import.meta.url)(path)({
  wasmBinary: readFileSync(path.replace(/js$/, "wasm")), // a script of emscripten 3.1 would fetch it, which Node does not for files
  print: console.error,
  printErr: console.error,
});

// A text in the core's memory for as long as a call takes.
function withTexts(texts, call) {
  const places = texts.map((text) => {
    const size = core.lengthBytesUTF8(text) + 1, at = core._malloc(size);
    core.stringToUTF8(text, at, size);
    return at;
  });
  const told = core.UTF8ToString(call(...places));
  places.forEach((at) => core._free(at));
  return told;
}

// JSON as a value of TOML. A key without a value is left out; that of a fixed surface's inertia has none.
export function toml(value) {
  if (Array.isArray(value)) return `[${value.map(toml).join(", ")}]`;
  if (typeof value !== "object") return JSON.stringify(value);
  const rows = Object.entries(value).filter(([, one]) => ![one].flat().includes(null));
  return `{ ${rows.map(([key, one]) => `${key} = ${toml(one)}`).join(", ")} }`;
}

const { lanes, ...info } = JSON.parse(core.UTF8ToString(core._rigor_info()));
const order = ({ name }) => (name === "semi-implicit-euler" ? 0 : 1);
info.methods = info.methods.filter((one) => one.leapfrog_stagger >= 0).sort((a, b) => order(a) - order(b)); // the first is the default
info.features = info.features.filter((word) => !/convex|heightfield|mesh/.test(word)); // they need Qhull, which is not linked in
let loaded = 0;

serve({
  info: { ...info, name: lanes === "plain" ? "core-wasm-plain" : "core-wasm", columns: "f64le", calls: ["run"] },
  load(scene, { method, options }) {
    const id = ++loaded, run = [`core:${method}`, ...Object.entries(options ?? {}).map(([key, value]) => `${key}=${value}`)].join(",");
    const refused = withTexts([`scene = ${toml(scene)}\n`, run], (...texts) => core._rigor_load(id, ...texts));
    if (refused) throw new Error(refused);
    return {
      settings: { lanes, ...JSON.parse(core.UTF8ToString(core._rigor_settings(id))) },
      step(dt) {
        const failed = core._rigor_step(id, dt);
        if (core.HEAPU8[failed]) throw new Error(core.UTF8ToString(failed));
      },
      rows() {
        const at = core._rigor_read(id) / 8 + 1;
        return scene.body.map((_, i) => Array.from(core.HEAPF64.subarray(at + 13 * i, at + 13 * i + 13)));
      },
      free: () => core._rigor_unload(id),
    };
  },
});
