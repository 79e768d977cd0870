// The machine and build that produced the results.
#pragma once

#include <string>

namespace rigor::inline report {

struct Machine {
  std::string program_version, cpu, compiler, build_type;
  int cores;
};
Machine this_machine();

}  // namespace rigor::inline report
