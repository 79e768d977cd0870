// The search for the largest step at which an engine's run does not blow up.
#pragma once

#include "cases/results/results.h"

namespace rigor {

// Over `horizon` seconds, to 1 % by bisection in log dt. The limit is ragged: steps above the first bad one may hold
// again by luck. So it is the largest below which none tried is bad, steps being tried 3 % apart, or 20 % among bodies
// that touch and have no springs, over at least a factor of two below it. `energy_in_play`: J, see judge_stability.
StableStep largest_stable_dt(const Engine& engine, const Settings& settings, const Scene& scene, double horizon,
                             double energy_in_play);

}  // namespace rigor
