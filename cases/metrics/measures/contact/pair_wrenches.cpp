#include "cases/metrics/measures/contact/pair_wrenches.h"

#include "core/dynamics/model/loads/loads.h"

namespace rigor::inline metric {
namespace {

Vec3 angular_momentum_about_origin(const Body& body, BodyColumns bodies, std::size_t i) {
  const Mat3 R = matrix_of(bodies.orientation(i).normalized());
  const Vec3 spin = R * (body.inertia * (R.transpose() * bodies.angular_velocity(i)));
  return spin + bodies.position(i).cross(Vec3(body.mass * bodies.velocity(i)));
}

}  // namespace

Vec3 mean_position(BodyColumns before, BodyColumns after, std::size_t body, double dt) {
  return 0.5 * (before.position(body) + after.position(body)) +
         dt / 12 * (before.velocity(body) - after.velocity(body));
}

std::vector<Vec3> moments_on_bodies(const Scene& scene, BodyColumns before, BodyColumns after, double t, double dt) {
  std::vector<Vec3> moments(scene.bodies.size(), Vec3::Zero());
  for (std::size_t i = 0; i < moments.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed) continue;
    const Vec3 change = angular_momentum_about_origin(body, after, i) - angular_momentum_about_origin(body, before, i);
    moments[i] = change / dt - mean_position(before, after, i, dt).cross(Vec3(body.mass * scene.gravity));
  }
  for (const TimedForce& load : scene.forces) {
    const auto i = static_cast<std::size_t>(load.body);
    const Vec3 arm = 0.5 * (before.orientation(i) * load.point + after.orientation(i) * load.point);
    const Vec3 moment = (mean_position(before, after, i, dt) + arm).cross(load.force) + load.torque;
    moments[i] -= share_of_step(load, t, dt) * moment;
  }
  return moments;
}

PairWrenches reported_pair_wrenches(const JudgedRun& run, std::size_t n) {
  const BodyColumns start = run.trajectory.samples[n - 1].bodies.columns();
  PairWrenches wrenches;
  for (const ReportedContact& contact : run.trajectory.samples[n].contacts) {
    const BodyPair pair = pair_of(run.scene, contact.a, contact.b);
    const Vec3 force = contact.b == pair.second ? contact.force : Vec3(-contact.force);
    PairWrench& wrench = wrenches[pair];
    wrench.force += force;
    wrench.moment += (contact.point - start.position(static_cast<std::size_t>(pair.second))).cross(force);
  }
  return wrenches;
}

}  // namespace rigor::inline metric
