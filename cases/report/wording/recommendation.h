// The first answer of each report: which engine and which step to take, or which comes nearest to a recording.
#pragma once

#include <optional>
#include <string>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// "For 1 mm take simbody at 1/30 s", and in `more` what else is within the tolerance. Where nothing is
// compared but recordings, the finding on these, with its topic. None where no error can be compared.
std::optional<Message> recommendation(const Results& results);

// Whether no body moves in any case, by their truths. Errors then say whether a run keeps bodies at rest, and no more.
bool nothing_moves(const Results& results);
// "Nothing moves in this case, so it tells no step size."
std::string nothing_moves_text(const Results& results);

}  // namespace rigor::inline report
