// What is said of a run that is repeated.
#pragma once

#include <string>

#include "cases/analysis/repeats/repeats.h"

namespace rigor::inline report {

std::string text_of(const RepeatReport& report);

}  // namespace rigor::inline report
