// Shortens results of many cases. Each cell keeps its result. The details, nine tenths of the text, appear only if few
// cases are requested.
#pragma once

#include <cstddef>

#include "core/base/json_fwd.h"

namespace rigor::inline report {

inline constexpr std::size_t kMostCasesInDetail = 10;

// Removes from the output of results_json():
// - data of a metric besides its value, and metrics without one; a twin's own metrics;
// - answers of gates that held, and parts of answers that repeat the cell; limits that a gate does not have;
// - reasons of stability; spreads, the data behind observed orders, missing orders, and stable steps that nobody
//   requested.
// The first cell with some settings keeps them; `settings_of` of a later cell is the number of that cell. Metrics that
// nobody requested in any cell of a case are listed once per case: `not_measured`.
void leave_out_details(Json& results);

}  // namespace rigor::inline report
