// Checks that case.schema.json accepts valid files and rejects broken ones.
// node case_schema_test.mjs FOLDER-OF-node_modules SCHEMA VALID.json BROKEN.json
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const [modules, ...files] = process.argv.slice(2);
const [schema, valid, broken] = files.map((file) => JSON.parse(readFileSync(file, "utf8")));
const Ajv = createRequire(join(modules, "index.js"))("ajv");
// Strict, so that a mistyped rule is an error and not a rule that holds for everything.
const validate = new Ajv({ allErrors: true, strict: true, strictTypes: false, strictTuples: false, strictRequired: false }).compile(schema);

let wrong = 0;
for (const [id, one] of Object.entries(valid)) {
  if (validate(one)) continue;
  ++wrong;
  for (const { instancePath, message } of validate.errors.slice(0, 5)) console.log(`${id}: ${instancePath} ${message}`);
}
for (const one of broken) {
  if (!validate(one)) continue;
  ++wrong;
  console.log(`taken, and should not be: ${JSON.stringify(one)}`);
}
console.log(`${Object.keys(valid).length} cases, ${broken.length} broken ones; ${wrong} wrong`);
process.exit(wrong || !Object.keys(valid).length || !broken.length ? 1 : 0);
