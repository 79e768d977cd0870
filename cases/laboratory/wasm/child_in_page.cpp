// In place of adapters/plugin/child_process.cpp: an engine of the npm registry stands in the same worker and answers at
// once. serve.mjs hands its answers to rigorHost (page/src/engine_host.js).
#include <emscripten.h>

#include <cstdlib>

#include "adapters/plugin/child_process.h"
#include "core/engine/engine_failure.h"

// Returns the answer, to be freed.
EM_JS(char*, rigor_ask_engine, (const char* line), {
  const told = self.rigorAnswer ? self.rigorAnswer(UTF8ToString(line))
                                : '{"ok":false,"status":"failed","why":"the engine is not in this worker"}';
  const size = lengthBytesUTF8(told) + 1;
  const room = _malloc(size);
  stringToUTF8(told, room, size);
  return room;
});

// The columns that stand beside the last answer.
EM_JS(int, rigor_take_columns, (char* into, int bytes), {
  let at = into;
  for (const columns of self.rigorRaw || []) {
    const part = new Uint8Array(columns.buffer);
    if (at + part.length > into + bytes) return 0;
    HEAPU8.set(part, at);
    at += part.length;
  }
  self.rigorRaw = [];
  return at < into + bytes ? 0 : 1;
});

namespace rigor::inline adapters {

ChildProcess::ChildProcess(std::string command, double limit, int log, std::string name)
    : command_(std::move(command)), name_(std::move(name)), limit_(limit), log_(log) {}
ChildProcess::~ChildProcess() = default;

std::string ChildProcess::ask(const std::string& line, const std::string&, std::size_t) {
  char* told = rigor_ask_engine(line.c_str());
  std::string answer = told;
  std::free(told);
  return answer;
}

void ChildProcess::receive(char* into, std::size_t bytes, const std::string& request) {
  if (!rigor_take_columns(into, static_cast<int>(bytes)))
    throw EngineFailure(FailureKind::invalid, name_ + " has other numbers than asked for after '" + request + "'");
}

double ChildProcess::cpu_seconds() const { return 0; }
bool ChildProcess::is_ours() const { return true; }

}  // namespace rigor::inline adapters
