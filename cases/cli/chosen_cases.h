// The cases that a command line names. Losses of an import are reported on the way.
#pragma once

#include <vector>

#include "cases/case/vocabulary.h"
#include "cases/cli/commands.h"
#include "cases/runner/grid.h"

namespace rigor::inline cli {

std::vector<Case> chosen_cases(const CaseWords& cases, const Invocation& invocation, const Vocabulary& words);

// Says on stderr that a robot stands in empty space, if it does. Names --ground.
void say_if_it_falls(const std::string& file, const Scene& scene);

// The same with other steps and another duration. A case of a family or folder that these do not fit is left out and
// named. Throws InputError for a case that is itself named, and if none is left.
std::vector<Case> overridden_cases(const CaseWords& cases, const Invocation& invocation, const Overrides& overrides,
                                   const Vocabulary& words);

}  // namespace rigor::inline cli
