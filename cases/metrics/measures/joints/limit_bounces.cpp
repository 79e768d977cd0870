#include "cases/metrics/measures/joints/limit_bounces.h"

#include <algorithm>
#include <functional>

#include "core/dynamics/model/joint_coordinate.h"

namespace rigor::inline metric {
namespace {

// The first sample after each bounce of this joint among the first samples. `bodies` gives a sample's bodies.
std::vector<std::size_t> bounces_of(const JudgedRun& run, const Joint& joint, std::size_t count,
                                    const std::function<BodyColumns(std::size_t)>& bodies) {
  constexpr double kStops = 1e-6;  // of the speed before: what is left of a stop without rebound
  const JointCoordinate coordinate(run.scene, joint);
  std::vector<std::size_t> bounces;
  JointCoordinate::Value last = coordinate.at(bodies(0));
  for (std::size_t n = 1; n < count; ++n) {
    JointCoordinate::Value now = coordinate.at(bodies(n));
    now.x = coordinate.with_turns(now.x, last.x);
    const double reach = 2 * (run.trajectory.samples[n].time - run.trajectory.samples[n - 1].time) * last.rate;
    const bool meets = last.rate > 0 ? last.x + reach >= joint.upper : last.x + reach <= joint.lower;
    if (last.rate != 0 && meets && now.rate / last.rate <= kStops) bounces.push_back(n);
    last = now;
  }
  return bounces;
}

}  // namespace

std::vector<double> with_bounces_in_step(const JudgedRun& run, std::vector<double> energies) {
  const std::vector<double> of_truth = energies;
  for (const Joint& joint : run.scene.joints) {
    if (!joint.has_limits() || joint.restitution == 1 || energies.empty()) continue;
    const auto in_truth = bounces_of(run, joint, energies.size(),
                                     [&](std::size_t n) { return BodyColumns(run.truth->bodies[n].columns()); });
    const auto in_run = bounces_of(run, joint, energies.size(), [&](std::size_t n) {
      return BodyColumns(run.trajectory.samples[n].bodies.columns());
    });
    for (std::size_t k = 0; k < std::min(in_truth.size(), in_run.size()); ++k) {
      const std::size_t truth = in_truth[k];
      const double same_side = in_run[k] > truth ? of_truth[truth - 1] : of_truth[truth];
      for (std::size_t n = std::min(truth, in_run[k]); n < std::max(truth, in_run[k]); ++n) energies[n] = same_side;
    }
  }
  return energies;
}

}  // namespace rigor::inline metric
