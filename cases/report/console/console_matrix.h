// The verdict matrix as a terminal shows it: cases by engines in plain text of at most 100 columns, so many engines
// side by side as fit and the rest in further panels below.
#pragma once

#include <string>

#include "cases/results/results.h"

namespace rigor {

std::string console_matrix(const Results& results);

}  // namespace rigor
