// Makes the text of --help from the table of commands.
#pragma once

#include <string>

#include "cases/cli/commands.h"

namespace rigor::inline cli {

std::string help_text();
std::string help_text(const CommandRow& row);

// The answer to a call without a command: commands to try first.
std::string first_steps();

}  // namespace rigor::inline cli
