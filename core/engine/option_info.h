// An option of a method: its values, its default and its meaning. Every reader of an option takes these from here: the
// parser of runs, worlds, twins, lists, pages and messages.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/scene/features/features.h"

namespace rigor::inline engine {

enum class Track;

// A default that follows from the scene or the engine: the rule in words. Empty if an engine from outside names none.
struct DefaultRule {
  std::string text;
};
// The value in force if a run does not name the option: a rule, a number, or one of the choices.
using OptionDefault = std::variant<DefaultRule, double, std::string>;

// A key=value that a run's name may carry.
struct OptionInfo {
  std::string name;
  std::string meaning;                    // with its unit
  std::vector<std::string> choices = {};  // the words allowed; empty: a number
  double min = 0, max = 0;                // the numbers allowed, where there are no choices
  bool whole = false;                     // only whole numbers
  OptionDefault by_default = DefaultRule{};
  std::optional<OptionDefault> as_shipped = {};  // the default on the track `stock`, if it differs
  // For an option that decides what can be expressed: the part of EngineInfo::features that each choice has. A run that
  // does not name the option uses the first choice that expresses the scene.
  // A number has one row, under "": a run that names the option has these features even if its method lacks them.
  std::map<std::string, Features> features_of_choice = {};
};

const OptionDefault& default_of(const OptionInfo& option, Track track);
// The value as a run's name writes it. None if the default is a rule.
std::optional<std::string> default_value(const OptionInfo& option, Track track);
// "0.5", "100, stock 1" or a rule in words. Empty if no default is known.
std::string default_text(const OptionInfo& option);

}  // namespace rigor::inline engine
