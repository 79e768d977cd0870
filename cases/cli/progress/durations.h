// Durations in words, for plans and progress.
#pragma once

#include <string>

namespace rigor::inline cli {

std::string duration_text(double seconds);  // "42 s", "5 minutes", "3 hours"

// "20 to 60 s", "50 s to 3 minutes"; one value if both ends round to the same. The lower end is never rounded up.
std::string duration_range(double least, double most);

}  // namespace rigor::inline cli
