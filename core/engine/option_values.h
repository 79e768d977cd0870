// The value of an option in a run: the one that the run names, otherwise the default of the option's own row. Named
// values have been checked against the row before a scene is loaded.
#pragma once

#include <optional>
#include <string>

#include "core/engine/engine.h"

namespace rigor::inline engine {

bool is_named(const Settings& settings, const OptionInfo& option);

// The value in force. The default must be a number or a word.
double number_option(const Settings& settings, const OptionInfo& option);
std::string word_option(const Settings& settings, const OptionInfo& option);
// The same for an option whose default may be a rule; `by_rule` is then the value that the rule gives.
double number_option(const Settings& settings, const OptionInfo& option, double by_rule);

// The value that an adapter sets. None on the track `stock` if the run does not name the option, because its engine
// then stays as shipped. None if the default is a rule.
std::optional<double> number_to_set(const Settings& settings, const OptionInfo& option);
std::optional<std::string> word_to_set(const Settings& settings, const OptionInfo& option);

}  // namespace rigor::inline engine
