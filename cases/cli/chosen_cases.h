// The cases that a command line names; of what was imported on the way it is said what was left out.
#pragma once

#include <vector>

#include "cases/case/vocabulary.h"
#include "cases/cli/command_line.h"

namespace rigor {

std::vector<Case> chosen_cases(const CommandLine& line, const Vocabulary& words);
// With the line's steps and duration. A case of the suite or a folder that these do not suit is left out and named;
// InputError for one that is named itself, and where none is left.
std::vector<Case> overridden_cases(const CommandLine& line, const Vocabulary& words);

}  // namespace rigor
