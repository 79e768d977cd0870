// Checks that the published schemas accept real messages and reject invalid ones.
// node protocol_test.mjs FOLDER-OF-node_modules FOLDER-OF-SCHEMAS SAID.json SCENES.json
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";

const [modules, folder, ...files] = process.argv.slice(2);
const read = (file) => JSON.parse(readFileSync(file, "utf8"));
const [said, scenes] = files.map(read);
const Ajv = createRequire(join(modules, "index.js"))("ajv");

const [scene, protocol] = ["scene", "protocol"].map((name) => read(join(folder, `${name}.schema.json`)));

// A shape with a pose is any solid with two keys more. A closed solid would refuse these keys, so each gets them first.
function widened(part) {
  const solids = scene.definitions[part.allOf[0].$ref.split("/").at(-1)].oneOf;
  const { required, properties } = part;
  return { oneOf: solids.map((one) => ({ ...one, required: [...one.required, ...required], properties: { ...one.properties, ...properties } })) };
}

// The published schemas accept unknown keys, for later versions. Here each written key must be in the schema.
function closed(part) {
  if (Array.isArray(part)) return part.map(closed);
  if (part === null || typeof part !== "object") return part;
  if (part.allOf && part.properties) return closed(widened(part));
  const copy = Object.fromEntries(Object.entries(part).map(([key, value]) => [key, closed(value)]));
  return copy.type === "object" && copy.properties ? { ...copy, additionalProperties: false } : copy;
}

let wrong = 0, seen = 0;
function check(label, validate, value, isDue = true) {
  ++seen;
  if (validate(value) === isDue) return;
  ++wrong;
  console.log(`${label}: ${isDue ? JSON.stringify(validate.errors.slice(0, 4)) : "taken, and should not be"}: ${JSON.stringify(value).slice(0, 300)}`);
}

for (const change of [(x) => x, closed]) {
  const ajv = new Ajv({ allErrors: true, strict: true, strictTypes: false, strictTuples: false, strictRequired: false });
  ajv.addSchema(change(scene)), ajv.addSchema(change(protocol));
  const of = (definition) => ajv.getSchema(`${protocol.$id}#/definitions/${definition}`);
  const ofScene = ajv.getSchema(scene.$id);
  for (const [id, one] of Object.entries(scenes)) check(id, ofScene, one);
  said.requests.forEach((request, n) => {
    const answer = said.answers[n];
    const kind = !answer.ok ? "refusal" : { step: "done", unload: "done" }[request.call] ?? request.call;
    check("request", of("request"), request);
    if (change !== closed) check(`answer to ${request.call}`, of(kind), answer); // an engine may say more
  });
  const info = said.answers[0], loaded = said.answers[said.requests.findIndex(({ call }) => call === "read")];
  const broken = [
    ["info", { ...info, precision: "quad" }], ["info", { ...info, methods: [] }], ["info", { ...info, name: "a b" }],
    ["info", { ...info, columns: "f32" }], ["read", { ...loaded, bodies: [[1, 2]] }], ["read", { ...loaded, time: null }],
    ["read", { ...loaded, bodies: [loaded.bodies[0].map(String)] }], ["refusal", { ok: false, status: "sad", why: "x" }],
    ["refusal", { ok: false, status: "failed" }], ["done", { ok: "yes" }], ["request", { call: "step", world: 1 }],
    ["request", { call: "info" }], ["request", { call: "dance", world: 1 }], ["request", { call: "load", world: 1, scene: {}, settings: {} }],
  ];
  for (const [kind, one] of broken) check(kind, of(kind), one, false);
  const first = Object.values(scenes)[0];
  check("a scene without bodies", ofScene, { ...first, body: [] }, false);
  check("a scene with a body without mass", ofScene, { ...first, body: [{ ...first.body[0], mass: undefined }] }, false);
}
console.log(`${seen} looked at, ${wrong} wrong`);
process.exit(wrong || seen < 100 ? 1 : 0);
