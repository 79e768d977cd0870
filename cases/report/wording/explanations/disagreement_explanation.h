// How far engines are apart where no truth can say which of them is right.
#pragma once

#include <vector>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// At the smallest step that at least two engines ran, with the first run of each. An engine stands apart if even the
// nearest other is farther away than ten times the median of all such distances, and three times as far as the others
// are from each other. The quantities that these messages state:
//   distance between runs       m, the largest over time and bodies; `of_run` and the run `part`
//   distance of the nearest     m, of `of_run` to the nearest of the other engines
//   engines compared            how many there are
std::vector<Message> disagreement_explanations(const Results& results, const CaseResult& result);

}  // namespace rigor::inline report
