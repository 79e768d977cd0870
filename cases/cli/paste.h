// Commands that are printed for pasting into a shell.
#pragma once

#include <string>

#include "cases/cli/command_line.h"

namespace rigor {

// The text as one word of a POSIX shell, in single quotes if it needs them.
std::string shell_word(const std::string& text);

// The options by which another command finds the same cases and engines, each after a blank: --suite, --plugin. A suite
// that is Rigor's own needs none.
std::string same_sources(const CommandLine& line);

}  // namespace rigor
