// Builds the laboratory's page, one file that needs nothing else:
//   node build.mjs FOLDER-OF-node_modules FOLDER-OF-rigor_play SUITE OUT.html
// The simulators, their worker's script and the suite's cases go in packed. The page's own script is named by its hash in
// the content security policy, and no other script runs.
import { createHash } from "node:crypto";
import { existsSync, readdirSync, readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { instanceOf } from "./src/instance.js";

const [modules, simulators, suite, out] = process.argv.slice(2);
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
const worker = readFileSync(join(simulators, "rigor_play.js"), "utf8") + "\n" + (await bundled("worker.js", { format: "iife" }));
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
    else if (methods.every((one) => facts.lacks[one.name])) console.log(`left out: ${id}: ${Object.values(facts.lacks)[0]}`);
    else cases.push({ id, title: facts.title, text });
  }
  return cases;
}

const cases = await runnableCases();
const packed = (data) => gzipSync(data, { level: 9 }).toString("base64");
const block = (id, data) => `<script type="text/plain" id="${id}">${packed(data)}</script>`;
if (/<\/script/i.test(script)) throw new Error("the bundle would end its own <script> element");
const hash = `sha256-${createHash("sha256").update(script).digest("base64")}`;
const policy =
  `default-src 'none'; script-src '${hash}' 'wasm-unsafe-eval'; worker-src blob:; style-src 'unsafe-inline'; ` +
  "img-src data: blob:; base-uri 'none'; form-action 'none'";

const licences = ["three", "uplot"].map((name) => {
  const { version } = JSON.parse(readFileSync(join(modules, name, "package.json"), "utf8"));
  return `${name} ${version}\n${readFileSync(join(modules, name, "LICENSE"), "utf8")}`;
});
for (const name of ["libeigen3-dev", "libfmt-dev", "libtomlplusplus-dev", "nlohmann-json3-dev", "libboost-dev", "libqhull-dev", "emscripten"]) {
  const file = `/usr/share/doc/${name}/copyright`;
  if (existsSync(file)) licences.push(`${name}\n${readFileSync(file, "utf8")}`);
}
writeFileSync(join(dirname(out), "licences.txt"), licences.join("\n\n"));

const page = `<!doctype html>
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
<script>${script}</script>
</body>
</html>
`;
writeFileSync(out, page);
const kB = (bytes) => `${Math.round(bytes / 1024)} kB`;
console.log(
  `${cases.length} cases; the page has ${kB(page.length)}, ${kB(gzipSync(page, { level: 9 }).length)} compressed; ` +
    `of these the simulators ${kB(gzipSync(wasm, { level: 9 }).length)}`,
);
