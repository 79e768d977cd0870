#include "cases/metrics/measures/contact/pair_wrenches.h"

#include <algorithm>

#include "cases/metrics/measures/measuring.h"
#include "core/dynamics/model/loads/loads.h"

namespace rigor {
namespace {

Vec3 angular_momentum_about_origin(const Body& body, BodyColumns bodies, std::size_t i) {
  const Mat3 R = matrix_of(bodies.orientation(i).normalized());
  const Vec3 spin = R * (body.inertia * (R.transpose() * bodies.angular_velocity(i)));
  return spin + bodies.position(i).cross(Vec3(body.mass * bodies.velocity(i)));
}

Vec3 mean_position(BodyColumns before, BodyColumns after, std::size_t i, double dt) {
  return 0.5 * (before.position(i) + after.position(i)) + dt / 12 * (before.velocity(i) - after.velocity(i));
}

}  // namespace

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
    const auto end_of = [&](int body) {
      return run.scene.bodies[static_cast<std::size_t>(body)].fixed ? kWorld : body;
    };
    const int a = end_of(contact.a), b = end_of(contact.b), second = std::max(a, b);
    if (second == kWorld) continue;
    const Vec3 force = b == second ? contact.force : Vec3(-contact.force);
    PairWrench& wrench = wrenches[{std::min(a, b), second}];
    wrench.force += force;
    wrench.moment += (contact.point - start.position(static_cast<std::size_t>(second))).cross(force);
  }
  return wrenches;
}

std::optional<PairWrenches> true_pair_wrenches(const JudgedRun& run, std::size_t n) {
  const double t = run.trajectory.samples[n - 1].time, dt = run.trajectory.samples[n].time - t;
  const BodyColumns start = run.truth->bodies[n - 1].columns(), end = run.truth->bodies[n].columns();
  const std::optional<PairForces> forces = true_pair_forces(run, n);
  if (!forces) return std::nullopt;
  std::vector<BodyPair> touching;
  for (const auto& [pair, force] : *forces) touching.push_back(pair);
  const std::optional<PairForces> moments = pair_forces_of(touching, moments_on_bodies(run.scene, start, end, t, dt));
  if (!moments) return std::nullopt;
  PairWrenches wrenches;
  for (const auto& [pair, force] : *forces) {
    const Vec3 centre = mean_position(start, end, static_cast<std::size_t>(pair.second), dt);
    wrenches[pair] = {force, moments->at(pair) - centre.cross(force)};
  }
  return wrenches;
}

std::string why_no_wrenches(const JudgedRun& run) {
  if (const std::string why = why_no_contacts(run); !why.empty()) return why;
  if (!run.truth) return kNoTruth;
  if (!run.scene.springs.empty() || !run.scene.joints.empty())
    return "springs or joints hold bodies, and their forces are not among the contacts'";
  if (any_law(run.scene, [](const ContactLaw& law) { return law.resists_turning(); }))
    return "rolling or torsional friction adds a couple, which engines do not report with their contact forces";
  return samples_within(run, kTruthNeededPosition) < 2 ? kNoSamples : "";
}

}  // namespace rigor
