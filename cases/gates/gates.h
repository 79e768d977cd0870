// Holds the results of a case against the gates its file states.
#pragma once

#include "cases/gates/regression.h"
#include "cases/results/results.h"

namespace rigor::inline gates {

// |found - limit| <= kRounding * max(1, |limit|) counts as equal. This exceeds a thousand roundings of a double many
// times, and is far below any scheme error worth a gate.
inline constexpr double kRounding = 1e-9;

// Selected runs or steps restrict the gates: gates that exclude all of them give no answer.
enum class Asked { all, some };

// Fills in result.gates, and turns a cell from `pass` to `fail` if a gate fails. A gate fails on a cell that crashed,
// timed out or is invalid. Cells that are unsupported or lack the metric do not count. A gate without any cell is
// `not_checked`, once. A family's gate then gives no answer; see unmet_family_gates (failures.h).
void check_gates(CaseResult& result, const Results& grid, const RecordedValues& recorded = {},
                 Asked asked = Asked::all);

// Whether any gate held, failed, or is known not to hold.
bool is_any_judged(const Results& grid);

// Whether every gate was checked and held, and every case could be judged.
bool all_gates_hold(const Results& grid);

// " m": the unit that stands after a value of this metric; "" where it has none.
std::string unit_after(const std::string& metric);

}  // namespace rigor::inline gates
