#include "cases/runner/truth_samples.h"

#include "core/engine/simulation.h"

namespace rigor::inline runner {

void TruthOnSteps::keep(const Truth& truth, double dt, double duration, std::size_t bodies) {
  constexpr double kMostBytes = 128e6;
  const long steps = steps_in(duration, dt);
  const double bytes_each = sizeof(double) * static_cast<double>(kRotation * bodies) + sizeof(KeptBodies);
  if (bytes_each * static_cast<double>(steps) > kMostBytes) return;
  const auto [place, is_new] = by_dt_.try_emplace(dt);
  if (!is_new) return;
  Kept& kept = place->second;
  for (long n = 0; n <= steps; ++n) {
    const double t = static_cast<double>(n) * dt;  // as a world's clock counts
    kept.times.push_back(t);
    truth.at(t, kept.bodies.emplace_back(bodies).columns());
    kept.error.push_back(truth.error(t));
  }
}

TruthSamples TruthOnSteps::at_samples_of(const Trajectory& trajectory, const Truth& truth, std::size_t bodies,
                                         double largest_kinetic_energy) const {
  TruthSamples samples;
  samples.largest_kinetic_energy = largest_kinetic_energy;
  samples.source = &truth;
  const auto found = by_dt_.find(trajectory.dt);
  for (std::size_t n = 0; n < trajectory.samples.size(); ++n) {
    const double t = trajectory.samples[n].time;
    if (found != by_dt_.end() && n < found->second.times.size() && found->second.times[n] == t) {
      samples.bodies.push_back(found->second.bodies[n]), samples.error.push_back(found->second.error[n]);
    } else {
      truth.at(t, samples.bodies.emplace_back(bodies).columns());
      samples.error.push_back(truth.error(t));
    }
  }
  return samples;
}

}  // namespace rigor::inline runner
