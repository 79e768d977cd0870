// Whose friction is a cone, as Coulomb's, and whose a pyramid.
#pragma once

#include <optional>

#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/run_names.h"

namespace rigor::inline report {

// The quantity that this finding states: `worst friction_anisotropy` of a run over all cases at that step.
std::optional<Finding> friction_finding(const Results& results, const RunNames& names, const StepSize& dt);

}  // namespace rigor::inline report
