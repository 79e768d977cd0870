// The settings that a tuning chooses from.
#pragma once

#include <string>
#include <vector>

#include "core/engine/run_name.h"

namespace rigor {

// Those of an option that are tried: every choice, or numbers from its least to its largest, on a scale of logarithms
// where it spans more than two decades or begins at 0.
std::vector<std::string> tried_values(const OptionInfo& option);

// "ode:quickstep,erp=0.2@stock" with one option more, or with another value of it.
std::string with_option(const std::string& run, const std::string& option, const std::string& value);

// An engine's method with what `text` fixes, and the options that are left to choose. One row a method; a twin is none.
struct MethodSpace {
  std::string base;                 // a run's name
  std::vector<OptionInfo> options;  // not fixed
};
std::vector<MethodSpace> method_spaces(const std::string& text, const std::vector<EngineInfo>& engines);

}  // namespace rigor
