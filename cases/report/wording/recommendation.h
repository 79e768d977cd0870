// The first answer of each report: which engine and which step to take, or which comes nearest to a recording.
#pragma once

#include <optional>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// "For 1 mm take simbody at 1/30 s", and in `more` what else is within the tolerance. Where nothing is
// compared but recordings, the finding on these, with its topic. None where no error can be compared.
std::optional<Message> recommendation(const Results& results);

}  // namespace rigor::inline report
