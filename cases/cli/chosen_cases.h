// The cases that a command line names. Losses of an import are reported on the way.
#pragma once

#include <vector>

#include "cases/case/vocabulary.h"
#include "cases/cli/command_line.h"

namespace rigor {

std::vector<Case> chosen_cases(const CommandLine& line, const Vocabulary& words);

// Says on stderr that a robot stands in empty space, if it does. Names --ground.
void say_if_it_falls(const std::string& file, const Scene& scene);

// The same with the line's steps and duration. A case of a family or folder that these do not fit is left out and
// named. Throws InputError for a case that is itself named, and if none is left.
std::vector<Case> overridden_cases(const CommandLine& line, const Vocabulary& words);

}  // namespace rigor
