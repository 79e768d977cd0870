// The simulators: each in a worker of its own, so that the page stays fluid, and one that traps costs its panel alone.
const unpacked = async (id) => {
  const text = document.getElementById(id).textContent;
  const raw = atob(text),
    bytes = new Uint8Array(raw.length);
  for (let i = 0; i < raw.length; ++i) bytes[i] = raw.charCodeAt(i);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  return new Response(stream).arrayBuffer();
};

const asText = (buffer) => new TextDecoder().decode(buffer);

// The cases of the suite that the page carries: [{ id, text }].
export const carriedCases = async () => JSON.parse(asText(await unpacked("rigor-cases")));

// The engines from outside that the page carries: [{ name, info }]. Each has a worker's script of its own.
export const outside = JSON.parse(document.getElementById("rigor-engines")?.textContent ?? "[]");

let compiled = null;
export const compile = () => (compiled ??= unpacked("rigor-wasm").then((wasm) => WebAssembly.compile(wasm)));

// A page in a file has no address that a worker may be loaded from; a blob has one everywhere.
const addresses = new Map();
function addressOf(kind) {
  if (!addresses.has(kind)) {
    const script = unpacked(kind === "core" ? "rigor-worker" : `rigor-worker-${kind}`);
    addresses.set(
      kind,
      script.then((text) => URL.createObjectURL(new Blob([text], { type: "text/javascript" }))),
    );
  }
  return addresses.get(kind);
}

export class Simulator {
  // `kind`: "core", or the name of an engine from outside.
  constructor(kind = "core") {
    this.kind = kind;
    this.waiting = new Map();
    this.last = 0;
    this.started = this.start();
  }

  async start() {
    const [address, module] = await Promise.all([addressOf(this.kind), compile()]);
    if (this.closed) return;
    this.worker = new Worker(address);
    this.worker.onmessage = ({ data: { id, answer, numbers } }) => {
      const done = this.waiting.get(id);
      this.waiting.delete(id);
      if (answer.has_trapped) this.hasTrapped = true;
      done?.({ ...answer, numbers });
    };
    this.worker.onerror = (event) => this.fail(event.message ?? "its script failed");
    await this.send({ module });
    for (const { name, info } of outside) await this.send({ request: { call: "engine", command: name, info } });
  }

  send(message, transfer = []) {
    const id = ++this.last;
    return new Promise((done) => {
      this.waiting.set(id, done);
      this.worker.postMessage({ id, ...message }, transfer);
    });
  }

  fail(why) {
    this.hasTrapped = true;
    for (const done of this.waiting.values())
      done({ ok: false, has_trapped: true, why: `the simulator stopped: ${why}` });
    this.waiting.clear();
  }

  // The answer to a call of calls.h; `numbers` are copied, not taken.
  async call(request, numbers = null) {
    return this.ask(numbers ? { request, numbers } : { request });
  }
  // A call that reads files: [{ name, bytes }].
  async callWith(files, request) {
    return this.ask({ request, files });
  }
  async ask(message) {
    await this.started;
    if (this.closed) return { ok: false, is_closed: true, why: "closed" };
    return this.send(message);
  }

  get isBusy() {
    return this.waiting.size > 0;
  }

  close() {
    this.closed = true;
    this.worker?.terminate();
    for (const done of this.waiting.values()) done({ ok: false, is_closed: true, why: "closed" });
    this.waiting.clear();
  }
}
