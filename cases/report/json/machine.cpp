#include "cases/report/json/machine.h"

#include <fstream>
#include <thread>

namespace rigor::inline report {
namespace {

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string compiler() {
#ifdef __clang__
  return "clang " __clang_version__;
#else
  return "g++ " __VERSION__;
#endif
}

}  // namespace

Machine this_machine() {
  return {RIGOR_VERSION, cpu_model(), compiler(), RIGOR_BUILD_TYPE,
          static_cast<int>(std::thread::hardware_concurrency())};
}

}  // namespace rigor::inline report
