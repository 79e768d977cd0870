// The verdict on a run's stability.
#pragma once

#include <optional>

#include "cases/metrics/metric.h"
#include "cases/metrics/verdict.h"
#include "cases/truth/truth.h"
#include "core/engine/simulation.h"
#include "core/scene/scene.h"

namespace rigor::inline metric {

// Blown up: a number is not finite, or |E - E0| > 10 x the energy in play of the truth. That is its largest kinetic
// energy or, if larger, the largest change of its energy: a weight that dampers bring to rest moves little and loses
// much. Otherwise verdict.h judges. `not_finite`: where the simulation ended for that reason.
Stability judge_stability(const JudgedRun& run, const std::optional<NotFinite>& not_finite,
                          double largest_kinetic_energy, double largest_energy_change = 0);

// J, of the truth over [0, duration].
struct EnergyExtremes {
  double kinetic = 0;  // the largest; without a truth, or where it hardly moves (1e-9 of that), the scene's energy in
                       // play (energy_in_play.h)
  double change = 0;   // the largest |E - E0|; 0 without a truth
  bool is_still = false;  // no body moves in the truth
};
EnergyExtremes energy_extremes(const Scene& scene, const Truth* truth, double duration);

// Whether the energy's change from its start [J] is possible without a blow-up. Friction and impacts may remove any
// amount, as on a long slope; then only a rise is bounded. Also false if the energy is NaN.
bool is_bounded(double change, double energy_in_play, bool may_lose);

}  // namespace rigor::inline metric
