// Whether results.json is what its schema says: node schema_test.mjs FOLDER-OF-node_modules SCHEMA RESULTS.json
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const [modules, schemaFile, resultsFile] = process.argv.slice(2);
const Ajv = createRequire(join(modules, "index.js"))("ajv");
const read = (file) => JSON.parse(readFileSync(file, "utf8"));
const validator = new Ajv({ allErrors: true, strict: false });
const validate = validator.compile(read(schemaFile)),
  results = read(resultsFile);

if (!validate(results)) {
  for (const { instancePath, message } of validate.errors.slice(0, 20)) console.log(`${instancePath}: ${message}`);
  process.exit(1);
}
// A schema that refuses nothing would be none: each of these must be refused.
const broken = [
  (r) => {
    r.cells[0].status = "fine";
  },
  (r) => {
    delete r.cells[0].metrics;
  },
  (r) => {
    r.cases[0].duration = 0;
  },
  (r) => {
    r.schema = 1;
  },
  (r) => {
    r.cells.find((c) => Object.values(c.metrics).some((m) => "value" in m)).metrics = { x: { value: "1" } };
  },
  (r) => {
    r.cases[0].scene.bodies[0].shape = { type: "ball" };
  },
  (r) => {
    delete r.stable_dt[0].dt;
  },
];
broken.forEach((harm, i) => {
  const other = structuredClone(results);
  harm(other);
  if (validate(other)) throw new Error(`the schema lets break ${i} pass`);
});
console.log(`valid; ${broken.length} broken ones refused`);
