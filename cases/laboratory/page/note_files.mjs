// Notes which files of packages a program reads: node --import note_files.mjs PROGRAM, with RIGOR_NOTES=OUT.json
import fs from "node:fs";
import { syncBuiltinESMExports } from "node:module";

const { readFileSync, writeFileSync } = fs,
  noted = new Set();
fs.readFileSync = (path, ...rest) => {
  if (/node_modules.*\.(json|wasm)$/.test(String(path))) noted.add(String(path));
  return readFileSync(path, ...rest);
};
syncBuiltinESMExports();
process.on("exit", () => writeFileSync(process.env.RIGOR_NOTES, JSON.stringify([...noted])));
