// The settings from which a tuning chooses.
#pragma once

#include <string>
#include <vector>

#include "core/engine/run_name.h"

namespace rigor::inline analysis {

// The values of an option that are tried: every choice, or numbers from the smallest to the largest. The scale is
// logarithmic if the range spans more than two decades or begins at 0.
std::vector<std::string> tried_values(const OptionInfo& option);

// "ode:quickstep,erp=0.2@stock": the run with one more option, or with another value of it.
std::string with_option(const std::string& run, const std::string& option, const std::string& value);

// An engine's method with the options that `text` fixes, and the options left to choose. One row per method; twins are
// left out.
struct MethodSpace {
  std::string base;                 // a run's name
  std::vector<OptionInfo> options;  // not fixed
};
std::vector<MethodSpace> method_spaces(const std::string& text, const std::vector<EngineInfo>& engines);

}  // namespace rigor::inline analysis
