// The verdict matrix for a terminal: cases by engines in plain text of at most 100 columns. Engines stand side by side
// while they fit; further panels below show the rest.
#pragma once

#include <string>

#include "cases/results/results.h"

namespace rigor::inline report {

std::string console_matrix(const Results& results);

}  // namespace rigor::inline report
