// The cases that a command line names; of what was imported on the way it is said what was left out.
#pragma once

#include <vector>

#include "cases/case/vocabulary.h"
#include "cases/cli/command_line.h"

namespace rigor {

std::vector<Case> chosen_cases(const CommandLine& line, const Vocabulary& words);

}  // namespace rigor
