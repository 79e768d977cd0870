// What is said of two runs that part.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/divergence/divergence.h"

namespace rigor::inline report {

// Lines for a terminal. `run_command`: the winner of the settings as a command to paste; `calls`: of the engine itself.
std::string text_of(const Divergence& found, const std::string& run_command, const std::vector<std::string>& calls);

}  // namespace rigor::inline report
