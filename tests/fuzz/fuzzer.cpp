// libFuzzer's entry for one of the targets, which the build names: RIGOR_FUZZ_TARGET.
#include <cstdint>
#include <string>

#include "tests/fuzz/targets.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const rigor::fuzz::Target& target = []() -> const rigor::fuzz::Target& {
    for (const auto& each : rigor::fuzz::targets()) {
      if (each.name == RIGOR_FUZZ_TARGET) return each;
    }
    __builtin_trap();
  }();
  target.read({reinterpret_cast<const char*>(data), size});
  return 0;
}
