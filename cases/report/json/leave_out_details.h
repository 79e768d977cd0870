// A run of many cases tells of each cell what it came to; the details, which make up nine tenths of the text, are told
// where few cases are asked for.
#pragma once

#include <cstddef>
#include <nlohmann/json_fwd.hpp>

namespace rigor {

inline constexpr std::size_t kMostCasesInDetail = 10;

// Out of what results_json() made: what a metric is besides its value, and metrics without one; what held gates say;
// spreads, and what observed orders are made of. Settings stand with the first cell that has them: `settings_of` of a
// later one is that one's place among the cells.
void leave_out_details(nlohmann::ordered_json& results);

}  // namespace rigor
