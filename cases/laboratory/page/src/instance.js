// Calls of the laboratory's C++ code (cases/laboratory/calls.h) in one instance of its WebAssembly module.
export async function instanceOf(makeRigor, module) {
  const wasm = await makeRigor({
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
  return { call };
}
