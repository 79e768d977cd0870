// Whose joints hold and whose stretch, over all jointed cases.
#pragma once

#include <optional>
#include <vector>

#include "cases/report/wording/findings/findings.h"

namespace rigor::inline report {

// The quantities that this finding states:
//   worst joint gap over size   of a run, over all cases it did not blow up in
//   worst joint gap             m, in the case where that ratio is largest
//   joint size                  m, of that case's scene: see joint_diagnosis.h
// `runs`: the runs to report, in this order. Empty where no case has joints.
std::optional<Finding> joints_finding(const Results& results, const std::vector<std::size_t>& runs, const StepSize& dt);

}  // namespace rigor::inline report
