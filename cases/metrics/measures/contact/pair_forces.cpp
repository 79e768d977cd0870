#include "cases/metrics/measures/contact/pair_forces.h"

#include <fmt/format.h>

#include "cases/metrics/measures/contact/touching.h"
#include "core/dynamics/model/loads/loads.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {

BodyPair pair_of(const Scene& scene, int a, int b) {
  const auto is_fixed = [&](int body) { return scene.bodies[static_cast<std::size_t>(body)].fixed; };
  const bool a_is_first = is_fixed(a) != is_fixed(b) ? is_fixed(a) : a < b;
  return a_is_first ? BodyPair(a, b) : BodyPair(b, a);
}

PairForces reported_pair_forces(const Scene& scene, const Sample& sample) {
  PairForces forces;
  for (const ReportedContact& contact : sample.contacts) {
    const BodyPair pair = pair_of(scene, contact.a, contact.b);
    Vec3& force = forces.try_emplace(pair, Vec3::Zero()).first->second;
    force += pair.second == contact.b ? contact.force : Vec3(-contact.force);
  }
  return forces;
}

std::vector<Vec3> forces_on_bodies(const Scene& scene, BodyColumns before, BodyColumns after, double t, double dt) {
  std::vector<Vec3> forces(scene.bodies.size(), Vec3::Zero());
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (!body.fixed) forces[i] = body.mass * ((after.velocity(i) - before.velocity(i)) / dt - scene.gravity);
  }
  for (const TimedForce& force : scene.forces)
    forces[static_cast<std::size_t>(force.body)] -= share_of_step(force, t, dt) * force.force;
  return forces;
}

Vec3 slip_of(const ReportedContact& contact, BodyColumns bodies) {
  const Vec3 u = velocity_at(bodies, contact.b, contact.point) - velocity_at(bodies, contact.a, contact.point);
  return u - contact.normal.dot(u) * contact.normal;
}

std::string why_no_contacts(const JudgedRun& run) {
  if (!anything_can_touch(run.scene)) return "no two bodies of the scene can touch";
  if (run.trajectory.contacts == ContactRecords::not_asked_for)
    return "contact forces are recorded where a gate of the case names them";
  if (run.trajectory.contacts == ContactRecords::not_reported) return "the engine does not report contact forces";
  const std::vector<Sample>& samples = run.trajectory.samples;
  constexpr double kOneStep = 1.5;
  if (samples.size() < 2) return "the run has no finite step";
  if (samples[1].time > kOneStep * run.trajectory.dt) return "steps are not recorded one by one";
  return "";
}

std::string name_of(const Scene& scene, const BodyPair& pair) {
  return fmt::format("force of {} on {}", scene.body_name(pair.first), scene.body_name(pair.second));
}

}  // namespace rigor::inline metric
