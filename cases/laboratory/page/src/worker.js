// In a web worker: one instance of the simulators, which answers one call after another. The factory makeRigor stands
// before this script (build.mjs); the compiled module comes with the first message.
import { instanceOf } from "./instance.js";

let instance = null;

self.onmessage = async ({ data: { id, module, request, numbers, files } }) => {
  try {
    await self.rigorReady; // of an engine from outside; nothing in the core's worker
    if (module) instance = await instanceOf(self.makeRigor ?? makeRigor, module);
    if (files) instance.put(files);
    const answer = request ? instance.call(request, numbers) : { ok: true };
    const given = answer.numbers ?? new Float64Array();
    delete answer.numbers;
    self.postMessage({ id, answer, numbers: given }, [given.buffer]);
  } catch (error) {
    self.postMessage({
      id,
      answer: { ok: false, has_trapped: true, why: `the simulator stopped: ${error.message ?? error}` },
    });
  }
};
