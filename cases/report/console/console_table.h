// What `rigor run` prints: a block a case, one row an engine, in at most 100 columns and plain text; of many cases the
// matrix, cases by engines.
#pragma once

#include <string>

#include "cases/results/results.h"

namespace rigor {

std::string console_table(const Results& results);

// How many gates held, failed and were not checked.
std::string gate_summary(const Results& results);

// The parts of a row, in words and rounded to what can be read; report.md shows the same.
struct RowText {
  std::string engine;
  std::string first_second, whole, orientation, energy, energy_synchronised, stable_dt, verdict;
  bool has_numbers = true;  // if not, `verdict` is a sentence that stands in their place
  bool is_blown_up = false;
};
RowText row_text(const Results& results, const CaseResult& result, const Cell& cell);
std::string truth_sentence(const CaseResult& result);

// Broken at spaces to the table's width; each line stands behind `indent` columns, the first behind whatever of that
// width the caller has written already.
std::string wrapped(const std::string& text, std::size_t indent);

// Two or three significant digits: 0.0312, 1.3e-05, 490.
std::string rounded(double value);

// At most `width` bytes, cut between characters.
std::string shortened(std::string text, std::size_t width);

// The first column of a table; a long name gets a line of its own.
std::string engine_column(const std::string& name);

// The coarsest step of a case's run: the headline.
StepSize coarsest_dt(const CaseResult& result);

}  // namespace rigor
