// Holds the results of a case against the gates its file states.
#pragma once

#include "cases/gates/regression.h"
#include "cases/results/results.h"

namespace rigor {

// |found - limit| <= kRounding * max(1, |limit|) is equal: a thousand roundings of a double fit into it many times
// over, and no scheme's error that is worth a gate does.
inline constexpr double kRounding = 1e-9;

// Who names runs or steps asks for less than the gates do: gates that all of these leave out then give no answer.
enum class Asked { all, some };

// Fills in result.gates, and turns a cell that did `pass` into `fail` where a gate says so. A gate on a cell that
// crashed, timed out or is invalid fails; one that is unsupported or has no such metric it does not meet. A gate that
// met no cell is `not_checked`, once; a family's says nothing then, see unmet_family_gates (failures.h).
void check_gates(CaseResult& result, const Results& grid, const RecordedValues& recorded = {},
                 Asked asked = Asked::all);

// Whether any gate held, failed, or is known not to hold.
bool is_any_judged(const Results& grid);

// Whether every gate was checked and held, and every case could be judged.
bool all_gates_hold(const Results& grid);

// " m": the unit that stands after a value of this metric; "" where it has none.
std::string unit_after(const std::string& metric);

}  // namespace rigor
