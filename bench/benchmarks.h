// The benchmarks by name: "step/free-bodies/1000/core:rk4". Each measures the CPU time of the working thread. If the
// name gives a number of threads, it measures wall time.
#pragma once

#include <string>
#include <vector>

namespace rigor::bench {

// step_bench.cpp: every engine and method on every scene; those that take part on request only where `filter` is all
// (".") or names them.
void register_steps(const std::string& filter);
void register_limits();  // limits_bench.cpp: the lower bounds of any method
// plugin_bench.cpp: engines from outside, as --plugin and RIGOR_PLUGINS name them. Throws InputError.
void register_plugins(const std::vector<std::string>& plugins);
void register_harness();  // harness_bench.cpp: the cost of the seam, a cell, a case file and a truth

double thread_seconds();  // for which this thread has run
double wall_seconds();

}  // namespace rigor::bench
