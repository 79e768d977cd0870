// What the cells of a case say of each other, as tables of text and sentences: orders, work and precision, spread.
#pragma once

#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor {

struct TextTable {
  std::string heading;
  std::vector<std::vector<std::string>> rows;  // the header first; all of one length
};

// For each error worth comparing: the order and, for each dt, error and cost; then how many times less error than each
// baseline at each of its costs. Last the spread at the coarsest dt: distances above the diagonal, when they part
// below.
std::vector<TextTable> comparison_tables(const Results& results, const CaseResult& result);

// One sentence a baseline: what the best method of the core makes of the same CPU time, in whichever error it gains
// less.
std::vector<std::string> work_precision_sentences(const Results& results, const CaseResult& result);

}  // namespace rigor
