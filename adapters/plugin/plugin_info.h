// The description that an engine from outside gives in the JSON of its handshake. Unknown keys are ignored; a missing
// capability is false.
#pragma once

#include <string>

#include "core/engine/engine.h"

namespace rigor::inline adapters {

inline constexpr int kProtocolVersion = 1;

struct PluginInfo {
  EngineInfo engine;           // its features with those that `wrench` gives it
  Features declared;           // by itself
  bool can_run = false;        // answers `run`: many steps in one request
  bool has_state = false;      // answers `save` and `restore`
  bool has_contacts = false;   // answers `contacts`: the contact forces of the last step
  bool has_reactions = false;  // answers `reactions`: the loads of joints in the last step
  bool has_columns = false;    // may answer with raw doubles
};

// The line of an answer to `info`. `what`: how messages call the plug-in. Throws InputError.
PluginInfo read_plugin_info(const std::string& line, const std::string& what);

// The part of a scene's loads that Rigor works out for this engine before each step.
Scene loads_left_to_rigor(Scene scene, const PluginInfo& info);

// "settings" of `load`, as JSON: an option that is a number as one.
std::string settings_json(const PluginInfo& info, const Settings& settings);

}  // namespace rigor::inline adapters
