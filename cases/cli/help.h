// What --help prints, from the table of commands.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "cases/cli/commands.h"

namespace rigor {

std::string help_text();
std::string help_text(const CommandRow& row, const CLI::App& command);

// What to try first, for a call without a command.
std::string first_steps();

}  // namespace rigor
