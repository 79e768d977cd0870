// What is said of the mistake that an engine's error looks like.
#pragma once

#include <string>

#include "cases/analysis/mistakes/finder.h"

namespace rigor::inline report {

// Lines for a terminal. `run`: as it was named.
std::string text_of(const MistakeReport& report, const std::string& run);

// "99.9997 %": never rounded up to the whole.
std::string share_in_words(double share);

}  // namespace rigor::inline report
