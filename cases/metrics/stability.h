// The verdict on a run's stability, and the largest step at which it is not lost.
#pragma once

#include <optional>

#include "cases/metrics/metric.h"
#include "cases/metrics/verdict.h"
#include "cases/runner/simulate.h"
#include "cases/truth/truth.h"
#include "core/scene/scene.h"

namespace rigor {

// Blown up: a number is not finite, or |E - E0| > 10 x the energy that the truth has in play: its largest kinetic
// energy or, where that is more, the largest change of its energy. A weight that dampers let creep back to rest moves
// little and loses much. Else verdict.h judges. `not_finite`: where the simulation ended for it.
Stability judge_stability(const JudgedRun& run, const std::optional<NotFinite>& not_finite,
                          double largest_kinetic_energy, double largest_energy_change = 0);

// J, of the truth over [0, duration]; without a truth, or where it never moves, the scene's energy in play
// (energy_in_play.h).
double largest_kinetic_energy(const Scene& scene, const Truth* truth, double duration);

// J, the largest |E - E0| of the truth over [0, duration]; 0 without a truth.
double largest_energy_change(const Scene& scene, const Truth* truth, double duration);

// The largest step at which `engine` does not blow up over `horizon` seconds, to 1 % by bisection in log dt. The limit
// is ragged: steps above the first bad one may hold again by luck. So it is the largest below which none tried is bad,
// steps being tried 3 % apart, or 20 % among bodies that touch and have no springs, over at least a factor of two below
// it.
struct StableStep {
  double dt = 0;          // s
  bool is_cap = false;    // still stable at the largest step tried: dt is that one
  bool is_floor = false;  // blows up at the smallest step tried: dt is that one
};
StableStep largest_stable_dt(const Engine& engine, const Settings& settings, const Scene& scene, double horizon,
                             double energy_in_play);

}  // namespace rigor
