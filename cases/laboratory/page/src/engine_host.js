// In the worker of an engine of the npm registry: takes the calls of serve.mjs's engine, which the simulators make at
// once (wasm/child_in_page.cpp). Imported before the engine, which may need a while to start.
let isReady;
self.rigorReady = new Promise((done) => (isReady = done));
self.rigorHost = (answer) => ((self.rigorAnswer = answer), isReady());
