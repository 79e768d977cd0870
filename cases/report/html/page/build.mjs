// Bundles the page into one script and one style sheet and writes them as a C++ source:
//   node build.mjs FOLDER-OF-node_modules OUT.cpp
// Everything that is bundled comes from the folder that package-lock.json was installed to.
import { createHash } from "node:crypto";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const [modules, out] = process.argv.slice(2);
const here = dirname(fileURLToPath(import.meta.url));
const esbuild = createRequire(join(modules, "index.js"))("esbuild");

const common = {
  bundle: true,
  minify: true,
  write: false,
  nodePaths: [modules],
  logLevel: "warning",
  target: "es2020",
};
const script = await esbuild.build({
  ...common,
  entryPoints: [join(here, "src/main.js")],
  format: "iife",
  charset: "ascii",
  legalComments: "none",
});
const style = await esbuild.build({ ...common, entryPoints: [join(here, "src/style.css")] });
const siteStyle = await esbuild.build({ ...common, entryPoints: [join(here, "src/site.css")] });

const licences = ["three", "uplot"]
  .map((name) => {
    const { version } = JSON.parse(readFileSync(join(modules, name, "package.json"), "utf8"));
    return `${name} ${version}\n${readFileSync(join(modules, name, "LICENSE"), "utf8")}\n`;
  })
  .join("\n");

// A string literal of several lines; what cannot stand in one, or would end the element it goes into, is escaped.
function literal(name, text) {
  const bytes = Buffer.from(text, "utf8");
  let lines = "";
  for (let i = 0; i < bytes.length; i += 120) {
    let line = "";
    for (const byte of bytes.subarray(i, i + 120)) {
      const char = String.fromCharCode(byte);
      const isPlain = byte >= 32 && byte < 127 && char !== '"' && char !== "\\" && char !== "?";
      line += isPlain ? char : "\\" + byte.toString(8).padStart(3, "0");
    }
    lines += `    "${line}"\n`;
  }
  return `extern const std::string_view ${name};\nconst std::string_view ${name}(\n${lines}    , ${bytes.length});\n`;
}

const text = script.outputFiles[0].text;
if (/<\/script/i.test(text)) throw new Error("the bundle would end its own <script> element");
writeFileSync(
  out,
  `// Made by page/build.mjs; do not edit.
#include <string_view>

namespace rigor::inline report {
${literal("kPageScript", text)}
${literal("kPageScriptHash", `sha256-${createHash("sha256").update(text).digest("base64")}`)}
${literal("kPageStyle", style.outputFiles[0].text)}
${literal("kSiteStyle", siteStyle.outputFiles[0].text)}
${literal("kPageLicences", licences.replaceAll("--", "- -"))}
}  // namespace rigor::inline report
`,
);
