#include "cases/metrics/measures/contact/true_wrenches.h"

#include <algorithm>

namespace rigor::inline metric {
namespace {

Equilibrium over_step(const Scene& scene, const ContactLaws& laws, BodyColumns before, BodyColumns after, double t,
                      double dt) {
  const std::vector<Vec3> forces = forces_on_bodies(scene, before, after, t, dt),
                          moments = moments_on_bodies(scene, before, after, t, dt);
  std::vector<ContactLoad> loads(scene.bodies.size());
  for (std::size_t i = 0; i < loads.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed) {
      loads[i].is_fixed = true;
      continue;
    }
    const double speed = std::max(before.velocity(i).norm(), after.velocity(i).norm());
    loads[i] = {forces[i], moments[i], mean_position(before, after, i, dt),
                forces[i].norm() + body.mass * (scene.gravity.norm() + speed / dt), false};
  }
  return equilibrium_of(meeting_points(scene, laws, before, after, dt), std::move(loads));
}

bool are_same(const KeptBodies& a, const KeptBodies& b) {
  for (std::size_t c = 0; c < kColumnNames.size(); ++c) {
    const double *one = a.columns().column(static_cast<int>(c)), *other = b.columns().column(static_cast<int>(c));
    if (!std::equal(one, one + a.size(), other)) return false;
  }
  return true;
}

}  // namespace

// Where nothing moves and no force changes, a step has the forces of the step before.
bool TrueWrenches::is_as_before(std::size_t n) const {
  const auto& bodies = run_.truth->bodies;
  return known_of_ > 0 && known_of_ + 1 == n && run_.scene.forces.empty() && are_same(bodies[n - 2], bodies[n - 1]) &&
         are_same(bodies[n - 1], bodies[n]);
}

const Equilibrium& TrueWrenches::of_step(std::size_t n) {
  if (n != known_of_ && !is_as_before(n)) {
    const double t = run_.trajectory.samples[n - 1].time, dt = run_.trajectory.samples[n].time - t;
    known_ = over_step(run_.scene, laws_, run_.truth->bodies[n - 1].columns(), run_.truth->bodies[n].columns(), t, dt);
  }
  known_of_ = n;
  return known_;
}

Equilibrium wrenches_at_rest(const Scene& scene, BodyColumns bodies) {
  return over_step(scene, ContactLaws(scene), bodies, bodies, 0, 1);
}

}  // namespace rigor::inline metric
