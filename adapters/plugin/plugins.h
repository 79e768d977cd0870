// Engines from outside, as they are named on the command line and in the environment.
#pragma once

#include <string>
#include <vector>

#include "adapters/engines.h"

namespace rigor::inline adapters {

// A path that ends in ".so" is a shared library, anything else a command line. `limit`: seconds, see ChildProcess.
// Throws InputError for a plug-in that does not describe itself, or whose name is taken.
void add_plugin(EngineTable& table, const std::string& plugin, double limit);

// The plug-in that add_plugin made this engine of; empty for an engine of the program.
std::string plugin_of(const std::string& engine);

// The parts of RIGOR_PLUGINS, which colons separate.
std::vector<std::string> plugins_of_environment();

}  // namespace rigor::inline adapters
