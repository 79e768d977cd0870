// The laboratory for JavaScript: texts and columns of numbers by their addresses.
#include <emscripten.h>

#include <string>

#include "cases/laboratory/calls.h"

namespace {

rigor::LaboratoryCalls& calls() {
  static rigor::LaboratoryCalls one;  // of this instance: one run
  return one;
}

std::string& last_answer() {
  static std::string text;
  return text;
}

}  // namespace

extern "C" {

// Valid until the next call.
EMSCRIPTEN_KEEPALIVE const char* rigor_call(const char* request) {
  last_answer() = calls().answer(request);
  return last_answer().c_str();
}

EMSCRIPTEN_KEEPALIVE double* rigor_numbers() { return calls().numbers().data(); }
EMSCRIPTEN_KEEPALIVE int rigor_number_count() { return static_cast<int>(calls().numbers().size()); }

// Room for the numbers of the next call.
EMSCRIPTEN_KEEPALIVE double* rigor_room(int count) {
  calls().numbers().resize(static_cast<std::size_t>(count));
  return calls().numbers().data();
}
}
