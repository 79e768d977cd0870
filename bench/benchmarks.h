// What is timed, by name: "step/free-bodies/1000/core:rk4". Every timing is of CPU time of the thread that does the
// work, unless the name says how many threads do: then it is by the wall.
#pragma once

#include <string>
#include <vector>

namespace rigor::bench {

// step_bench.cpp: every engine and method on every scene; those that take part on request only where `filter` is all
// (".") or names them.
void register_steps(const std::string& filter);
void register_limits();  // limits_bench.cpp: what no method can undercut
// plugin_bench.cpp: engines from outside, as --plugin and RIGOR_PLUGINS name them. Throws InputError.
void register_plugins(const std::vector<std::string>& plugins);
void register_harness();  // harness_bench.cpp: what the seam, a cell, a case file and a truth cost

double thread_seconds();  // for which this thread has run
double wall_seconds();

}  // namespace rigor::bench
