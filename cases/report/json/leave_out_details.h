// A run of many cases tells of each cell what it came to; the details, which make up nine tenths of the text, are told
// where few cases are asked for.
#pragma once

#include <cstddef>

#include "core/base/json_fwd.h"

namespace rigor {

inline constexpr std::size_t kMostCasesInDetail = 10;

// Out of what results_json() made: what a metric is besides its value, and metrics without one; a twin's own metrics;
// what held gates say, and of any gate what it says of a cell a second time; limits that a gate has not; why a cell is
// stable; spreads, what observed orders are made of, those that there are not, and stable steps that nobody asked for.
// Settings stand with the first cell that has them: `settings_of` of a later one is that one's place among the cells.
// Metrics that nobody asked for in any cell of a case stand with the case: `not_measured`.
void leave_out_details(Json& results);

}  // namespace rigor
