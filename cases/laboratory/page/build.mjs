// Builds the laboratory's page, one file that needs nothing else:
//   node build.mjs FOLDER-OF-node_modules FOLDER-OF-rigor_play SUITE OUT.html [FOLDER-OF-ENGINES ENGINE…]
// With engines of the npm registry (adapters/plugin/examples/npm) it also writes engines.html beside it, which has these,
// too. The simulators, their worker's script and the suite's cases go in packed. The page's own script is named by its hash in
// the content security policy, and no other script runs.
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
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
const policy =
  `default-src 'none'; script-src '${hash}' 'wasm-unsafe-eval'; worker-src blob:; style-src 'unsafe-inline'; ` +
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
  "emscripten",
]) {
  const file = `/usr/share/doc/${name}/copyright`;
  if (existsSync(file)) licences.push(`${name}\n${readFileSync(file, "utf8")}`);
}
writeFileSync(join(dirname(out), "licences.txt"), licences.join("\n\n"));

// An engine as a worker's script, and what it says of itself.
async function engineOf(name) {
  const file = join(engineFolder, `${name}.mjs`),
    entry = ["engine_host.js", "worker.js"]
      .map((one) => `import ${JSON.stringify(join(here, "src", one))};`)
      .join("\n");
  const { outputFiles } = await esbuild.build({
    ...common,
    ...{
      stdin: { contents: `${entry}\nimport ${JSON.stringify(resolve(file))};`, resolveDir: here },
      format: "esm",
      target: "es2022",
    },
    ...{ define: { "import.meta.url": '""' } },
    ...{
      alias: { "node:fs": join(here, "src/no_files.js"), "node:module": join(here, "src/no_files.js") },
      nodePaths: [join(engineFolder, "node_modules"), modules],
    },
  });
  const told = execFileSync(process.execPath, [file], {
    input: '{"rigor":1,"call":"info"}\n',
    encoding: "utf8",
    stdio: ["pipe", "pipe", "ignore"],
  });
  // A worker that is a module cannot be loaded from a page in a file. As a function the module may still wait.
  return { name, info: JSON.parse(told.split("\n")[0]), script: `${glue}(async () => {${outputFiles[0].text}})();` };
}

const engines = [];
for (const name of engineNames) engines.push(await engineOf(name));

const pageWith = (carried, link) => `<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta http-equiv="Content-Security-Policy" content="${policy}">
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
const names = engines.map(({ info }) => info.name).join(" and ");
write(out, pageWith([], engines.length > 0 ? { file: "engines.html", text: `with ${names}` } : null));
if (engines.length > 0)
  write(join(dirname(out), "engines.html"), pageWith(engines, { file: "index.html", text: "the smaller page" }));
