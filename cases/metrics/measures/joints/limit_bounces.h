// Bounces at the limits of joints, in a run and in its truth.
#pragma once

#include <vector>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {

// J: the truth's energies at the run's samples, but for those between a bounce in the truth and the same bounce in the
// run. There the truth's energy on the run's side of the bounce is taken: just before it where the run comes late, just
// after it where the run comes early. A bounce takes its energy at once, so that the least delay would count as the
// whole loss at any step. The delay itself is an error of position and phase.
std::vector<double> with_bounces_in_step(const JudgedRun& run, std::vector<double> energies);

}  // namespace rigor::inline metric
