// Calls of the laboratory's C++ code (cases/laboratory/calls.h) in one instance of its WebAssembly module.
export async function instanceOf(makeRigor, module) {
  const wasm = await makeRigor({
    // The simulators then find MuJoCo 3 where they look for it (mjcf_reader.js).
    preRun(made) {
      if (!globalThis.rigorReadsMjcf) return;
      made.ENV.RIGOR_MUJOCO3 = "/mujoco3";
      made.FS.mkdirTree("/mujoco3/node_modules/@mujoco/mujoco");
    },
    instantiateWasm(imports, done) {
      WebAssembly.instantiate(module, imports).then((instance) => done(instance, module));
      return {};
    },
  });
  // The numbers of a call and of its answer are columns of doubles; the answer's are a copy.
  const call = (request, numbers = null) => {
    if (numbers) new Float64Array(wasm.HEAPU8.buffer, wasm._rigor_room(numbers.length), numbers.length).set(numbers);
    const json = JSON.stringify(request),
      size = wasm.lengthBytesUTF8(json) + 1,
      text = wasm._malloc(size);
    wasm.stringToUTF8(json, text, size);
    const answer = JSON.parse(wasm.UTF8ToString(wasm._rigor_call(text)));
    wasm._free(text);
    const count = wasm._rigor_number_count();
    answer.numbers = new Float64Array(wasm.HEAPU8.buffer, wasm._rigor_numbers(), count).slice();
    return answer;
  };
  // Files for the call "import", alone in their folder: [{ name, bytes }].
  const put = (files) => {
    const { FS } = wasm,
      folder = `/dropped-${++dropped}`;
    FS.mkdir(folder), FS.chdir(folder);
    for (const { name, bytes } of files) {
      const folders = name.split("/").slice(0, -1);
      folders.forEach((_, k) => FS.analyzePath(folders.slice(0, k + 1).join("/")).exists || FS.mkdir(folders.slice(0, k + 1).join("/")));
      FS.writeFile(name, bytes);
    }
  };
  let dropped = 0;
  globalThis.rigorFile = (path, encoding) => wasm.FS.readFile(path, encoding ? { encoding } : {});
  return { call, put };
}
