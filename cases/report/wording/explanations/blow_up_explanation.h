// Why runs of a case blew up at its coarsest step.
#pragma once

#include <vector>

#include "cases/report/wording/message.h"
#include "cases/results/results.h"

namespace rigor::inline report {

// The quantities that these messages state beside metrics:
//   spring frequency            rad/s, of the stiffest mode of the scene's springs and joint springs, joints held
//   spring frequency times dt
//   damping, inertia            of the element `part`
//   damping times dt over inertia
//   servo's kp                  N m/rad, N/m, of the servo `part`; its kd is `damping`
//   servo's step                kp dt²/I + 2 kd dt/I of the servo `part`
//   overdamped elements         the number of elements whose damping times dt over inertia exceeds 2
//   semi-implicit step          s, the largest at which semi-implicit Euler keeps the oscillator bounded: the stiffest
//                               mode, or the element `part`
//   energy growth               of the same oscillator in one step of the run; `part`: "mode", or the element
//   largest stable dt           s, as the search found it
std::vector<Message> blow_up_explanations(const Results& results, const CaseResult& result);

}  // namespace rigor::inline report
