// Runs of a case beside each other, as tables of text and sentences: orders, work and precision, spread.
#pragma once

#include <string>
#include <vector>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

struct TextTable {
  std::string heading;
  std::vector<std::vector<std::string>> rows;  // the header first; all of one length
};

// For each error worth comparing: the order and, for each dt, error and cost; then how many times less error than each
// baseline at each of its costs. Last the spread at the coarsest dt: distances above the diagonal, when they part
// below.
std::vector<TextTable> comparison_tables(const Results& results, const CaseResult& result);

// One message a baseline: the error of the core's best method at the same CPU time, for the error in which it gains
// less. The quantities that it states beside metrics, of the baseline's cell `dt`:
//   cost of a step            s
//   error at equal cost       of the core's method, `part`: the metric
//   times less at equal cost  likewise; `of_run` is the core's method, and `part` names metric and baseline
std::vector<Message> work_precision_messages(const Results& results, const CaseResult& result);

}  // namespace rigor::inline report
