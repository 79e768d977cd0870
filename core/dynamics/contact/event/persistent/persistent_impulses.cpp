// The impulses of persistent forces over a part of a step, for reports of contact forces.
#include <algorithm>

#include "core/dynamics/contact/event/persistent/persistent_contact.h"

namespace rigor::inline dynamics {
namespace {

// Gauss's nodes and weights on [0, 1]: exact for forces that are polynomials of degree five in time.
struct Node {
  double at, weight;
};
constexpr Node kNodes[] = {{0.11270166537925831, 5.0 / 18}, {0.5, 8.0 / 18}, {0.88729833462074169, 5.0 / 18}};

}  // namespace

// The forces of points at rest are those that chose their modes, which lie in their cones.
void PersistentContact::visit_forces_at_rest(BodyColumns state, double h, const SeeForce& see) {
  for (const PersistentPoint& point : points()) see(point, state, h);
}

// The forces of equations of motion are the least ones, and of a sticking point they may lie outside its cone. Where
// all points stick, the forces of a choice of modes have the same sums, and lie inside. Ends with the advance that the
// step itself takes, so that the points are as they were.
void PersistentContact::visit_forces(BodyColumns start, double t, double h, const SeeForce& see) {
  for (const PersistentPoint& point : resting_points_) see(point, start, h);
  if (points().empty()) return;
  const std::vector<PersistentPoint> kept = points();
  const bool all_stick = std::all_of(kept.begin(), kept.end(), [](const PersistentPoint& point) {
    return point.mode == PersistentPoint::Mode::sticks;
  });
  const long passes = passes_;
  sampled_ = start;
  for (const Node& node : kNodes) {
    advance(start, sampled_.columns(), t, node.at * h);
    const BodyColumns then = std::as_const(sampled_).columns();
    const bool in_cones = all_stick && modes_.violation(end_, wrench_at_end_) < 0;
    for (PersistentPoint point : points()) {
      if (in_cones) point.force = point.force_in_cone;
      see(point, then, node.weight * h);
    }
  }
  persistent_.points() = kept;
  advance(start, sampled_.columns(), t, h);
  passes_ = passes;
}

}  // namespace rigor::inline dynamics
