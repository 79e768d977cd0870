// Builds the laboratory's page, one file that needs nothing else:
//   node build.mjs FOLDER-OF-node_modules FOLDER-OF-rigor_play SUITE OUT.html [FOLDER-OF-ENGINES ENGINE…]
// With engines of the npm registry (adapters/plugin/examples/npm) it also writes engines.html beside it, which has these,
// too. The simulators, their worker's script and the suite's cases go in packed. The page's own script is named by its hash in
// the content security policy, and no other script runs.
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdtempSync, readdirSync, readFileSync, realpathSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { dirname, join, relative, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { instanceOf } from "./src/instance.js";

const [modules, simulators, suite, out, engineFolder, ...engineNames] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const required = createRequire(join(modules, "index.js"));
const esbuild = required("esbuild");

const common = {
  ...{ bundle: true, minify: true, write: false, nodePaths: [modules], logLevel: "warning" },
  ...{ target: "es2020", charset: "ascii", legalComments: "none" },
};
const bundled = async (entry, options = {}) =>
  (await esbuild.build({ ...common, entryPoints: [join(here, "src", entry)], ...options })).outputFiles[0].text;
const script = await bundled("main.js", { format: "iife" });
const style = await bundled("laboratory.css");
const glue = readFileSync(join(simulators, "rigor_play.js"), "utf8") + "\n";
const worker = glue + (await bundled("worker.js", { format: "iife" }));
const wasm = readFileSync(join(simulators, "rigor_play.wasm"));

// The cases that some method of the core runs. A case that needs another file is left out.
async function runnableCases() {
  const makeRigor = required(join(simulators, "rigor_play.js"));
  const { call } = await instanceOf(makeRigor, await WebAssembly.compile(wasm));
  const { methods } = call({ call: "methods" });
  const files = readdirSync(suite, { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile() && entry.name.endsWith(".toml") && entry.name !== "family.toml")
    .map((entry) => join(entry.parentPath ?? entry.path, entry.name))
    .sort();
  const cases = [];
  for (const file of files) {
    const id = relative(suite, file).replace(/\.toml$/, ""),
      text = readFileSync(file, "utf8"),
      facts = call({ call: "read", path: `${id}.toml`, text });
    if (!facts.ok) console.log(`left out: ${facts.why}`);
    else if (methods.every((one) => facts.lacks[one.name]))
      console.log(`left out: ${id}: ${Object.values(facts.lacks)[0]}`);
    else cases.push({ id, title: facts.title, text });
  }
  return cases;
}

const cases = await runnableCases();
const packed = (data) => gzipSync(data, { level: 9 }).toString("base64");
const block = (id, data) => `<script type="text/plain" id="${id}">${packed(data)}</script>`;
const data = (id, value) =>
  `<script type="application/json" id="${id}">${JSON.stringify(value).replaceAll("<", "\\u003c")}</script>`;
if (/<\/script/i.test(script)) throw new Error("the bundle would end its own <script> element");
const hash = `sha256-${createHash("sha256").update(script).digest("base64")}`;
const policyWith = (scripts) =>
  `default-src 'none'; script-src '${hash}' ${scripts}; worker-src blob:; style-src 'unsafe-inline'; ` +
  "img-src data: blob:; base-uri 'none'; form-action 'none'";

const licences = ["three", "uplot"].map((name) => {
  const { version } = JSON.parse(readFileSync(join(modules, name, "package.json"), "utf8"));
  return `${name} ${version}\n${readFileSync(join(modules, name, "LICENSE"), "utf8")}`;
});
for (const name of [
  "libeigen3-dev",
  "libfmt-dev",
  "libtomlplusplus-dev",
  "nlohmann-json3-dev",
  "libboost-dev",
  "libqhull-dev",
  "libode-dev",
  "libccd2",
  "libbullet-dev",
  "libtinyxml2-dev",
  "emscripten",
]) {
  const file = `/usr/share/doc/${name}/copyright`;
  if (existsSync(file)) licences.push(`${name}\n${readFileSync(file, "utf8")}`);
}
// Of the engines' packages: their own texts, or the name of the licence where a package has none.
const packages = engineFolder ? JSON.parse(readFileSync(join(engineFolder, "package.json"), "utf8")).dependencies : {};
for (const name of Object.keys(packages)) {
  const folder = join(engineFolder, "node_modules", name),
    { version, license } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8")),
    file = readdirSync(folder).find((one) => /^licen[cs]e/i.test(one));
  licences.push(`${name} ${version}\n${file ? readFileSync(join(folder, file), "utf8") : `licence: ${license}`}`);
}
writeFileSync(join(dirname(out), "licences.txt"), licences.join("\n\n"));

// What an engine says of itself, and the files of packages that it reads when it starts.
function started(file) {
  const folder = mkdtempSync(join(tmpdir(), "rigor-engine-")),
    notes = join(folder, "read.json");
  const told = execFileSync(process.execPath, ["--import", join(here, "note_files.mjs"), file], {
    input: '{"rigor":1,"call":"info"}\n',
    encoding: "utf8",
    stdio: ["pipe", "pipe", "ignore"],
    env: { ...process.env, RIGOR_NOTES: notes },
  });
  const paths = JSON.parse(readFileSync(notes, "utf8"));
  rmSync(folder, { recursive: true });
  return { info: JSON.parse(told.split("\n")[0]), paths };
}

// The files as a script, for src/no_files.js: their bytes by path, and the path of each name that the engine looks up.
function filesOf(file, paths) {
  const root = realpathSync(join(engineFolder, "node_modules")),
    local = (path) => relative(root, realpathSync(path)),
    find = createRequire(resolve(file));
  const bytes = Object.fromEntries(paths.map((path) => [local(path), readFileSync(path).toString("base64")])),
    names = [...readFileSync(file, "utf8").matchAll(/resolve\("([^"]+)"\)/g)].map(([, name]) => name),
    places = Object.fromEntries(names.map((name) => [name, local(find.resolve(name))]));
  return `self.rigorFiles = ${JSON.stringify(bytes)}; self.rigorPlaces = ${JSON.stringify(places)};\n`;
}

// Node's own modules, of which a page has none.
const withoutFiles = {
  name: "without-files",
  setup: (build) =>
    build.onResolve({ filter: /^(node:)?(crypto|fs|module|path|url|worker_threads)$/ }, () => ({
      path: join(here, "src/no_files.js"),
    })),
};

// The script by which MuJoCo 3 compiles MJCF: a worker that has MuJoCo reads such files, too.
const mjcfScript = /R"js\(([\s\S]*?)\)js"/.exec(
  readFileSync(join(here, "../../../adapters/mjcf/mujoco3_script.h"), "utf8"),
)[1];
const readsMjcf = (file) => `import { mujoco } from ${JSON.stringify(resolve(file))};
import { readMjcf } from ${JSON.stringify(join(here, "src/mjcf_reader.js"))};
${mjcfScript}
readMjcf((request, read, warnings) => answerTo(mujoco, request, read, warnings));`;

// An engine as a worker's script.
async function engineOf(name) {
  const file = join(engineFolder, `${name}.mjs`),
    { info, paths } = started(file),
    own = name === "mujoco" ? readsMjcf(file) : `import ${JSON.stringify(resolve(file))};`,
    entry = ["engine_host.js", "worker.js"]
      .map((one) => `import ${JSON.stringify(join(here, "src", one))};`)
      .join("\n");
  const { outputFiles } = await esbuild.build({
    ...common,
    ...{
      stdin: { contents: `${entry}\n${own}`, resolveDir: here },
      format: "esm",
      target: "es2022",
    },
    ...{ define: { "import.meta.url": '"file:///"' } },
    ...{ plugins: [withoutFiles], nodePaths: [join(engineFolder, "node_modules"), modules] },
  });
  // A worker that is a module cannot be loaded from a page in a file. As a function the module may still wait.
  return { name: info.name, info, script: `${filesOf(file, paths)}${glue}(async () => {${outputFiles[0].text}})();` };
}

const engines = [];
for (const name of engineNames) engines.push(await engineOf(name));

// MuJoCo's bindings make functions of texts when they start.
const policyFor = (carried) =>
  policyWith(carried.some(({ name }) => name === "mujoco-js") ? "'unsafe-eval'" : "'wasm-unsafe-eval'");

const pageWith = (carried, link) => `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policyFor(carried)}">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<title>Rigor: laboratory</title>
<style>
${style}</style>
</head>
<body>
<div id="page"><p class="loading">Starting the simulators &hellip;</p></div>
${block("rigor-cases", JSON.stringify(cases))}
${block("rigor-worker", worker)}
${block("rigor-wasm", wasm)}
${data(
  "rigor-engines",
  carried.map(({ name, info }) => ({ name, info })),
)}
${data("rigor-link", link)}
${carried.map(({ name, script: text }) => block(`rigor-worker-${name}`, text)).join("\n")}
<script>${script}</script>
</body>
</html>
`;
const kB = (bytes) => `${Math.round(bytes / 1024)} kB`;
function write(file, page) {
  writeFileSync(file, page);
  console.log(`${file}: ${kB(page.length)}, ${kB(gzipSync(page, { level: 9 }).length)} compressed`);
}
console.log(`${cases.length} cases; the simulators have ${kB(gzipSync(wasm, { level: 9 }).length)} compressed`);
const titles = { "mujoco-js": "MuJoCo 3", "cannon-es": "cannon-es", ammo: "ammo.js", physx: "PhysX" },
  titleOf = ({ name }) => titles[name] ?? name[0].toUpperCase() + name.slice(1),
  names = engines.map(titleOf).join(", ");
write(out, pageWith([], engines.length > 0 ? { file: "engines.html", text: "with more engines", title: names } : null));
if (engines.length > 0)
  write(join(dirname(out), "engines.html"), pageWith(engines, { file: "index.html", text: "the smaller page", title: "The core, ODE and Bullet" }));
