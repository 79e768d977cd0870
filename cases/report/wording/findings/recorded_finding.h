// Which engine comes nearest to a measured motion.
#pragma once

#include <optional>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// For each case with a recording: of each engine its best run and step, nearest first, and Rigor's core apart. A mean
// that lacks trials is not compared, because the trials that an engine fails on are the hard ones; it is named instead.
// None without such a case, and where no run can be compared with a recording.
std::optional<Message> recorded_finding(const Results& results);

}  // namespace rigor::inline report
