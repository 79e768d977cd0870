// Recomputes what a message states from the results and the scene alone, by code of its own.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::test {

// The value of the claim's quantity; nothing for a quantity that the oracle does not know.
std::optional<double> recomputed(const Results& results, const Claim& claim);

// What is wrong with a message: a value, a comparison or a printed number that does not follow from the results; a
// number in the text that no claim states. Empty if nothing is.
std::vector<std::string> errors_of(const Results& results, const Message& message);

// Likewise of all findings, and of the explanations and comparisons of all cases.
std::vector<std::string> errors_of_all_messages(const Results& results);

}  // namespace rigor::test
