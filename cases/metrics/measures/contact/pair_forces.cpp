#include "cases/metrics/measures/contact/pair_forces.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "cases/metrics/measures/shape_gap.h"
#include "core/dynamics/model/loads/loads.h"
#include "core/scene/contact_laws.h"

namespace rigor {
namespace {

// Of the smaller body's size: beyond the rounding of a truth's positions, below any gap that a scene means.
constexpr double kTouching = 1e-7;

int end_of(const Scene& scene, int body) { return scene.bodies[static_cast<std::size_t>(body)].fixed ? kWorld : body; }

}  // namespace

PairForces reported_pair_forces(const Scene& scene, const Sample& sample) {
  PairForces forces;
  for (const ReportedContact& contact : sample.contacts) {
    const int a = end_of(scene, contact.a), b = end_of(scene, contact.b);
    Vec3& force = forces.try_emplace({std::min(a, b), std::max(a, b)}, Vec3::Zero()).first->second;
    force += a < b ? contact.force : Vec3(-contact.force);
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

std::optional<PairForces> pair_forces_of(const std::vector<BodyPair>& touching, std::vector<Vec3> on_bodies) {
  std::set<BodyPair> open(touching.begin(), touching.end());
  PairForces forces;
  const auto pairs_of = [&](int body) {
    return std::count_if(open.begin(), open.end(),
                         [&](const BodyPair& pair) { return pair.first == body || pair.second == body; });
  };
  // A body with one pair left gets from it all that its other pairs do not give.
  while (!open.empty()) {
    const auto found = std::find_if(open.begin(), open.end(), [&](const BodyPair& pair) {
      return pairs_of(pair.second) == 1 || (pair.first != kWorld && pairs_of(pair.first) == 1);
    });
    if (found == open.end()) return std::nullopt;
    const auto [first, second] = *found;
    const bool ends_at_second = pairs_of(second) == 1;
    const auto leaf = static_cast<std::size_t>(ends_at_second ? second : first);
    const Vec3 on_second = ends_at_second ? on_bodies[leaf] : Vec3(-on_bodies[leaf]);
    forces[*found] = on_second;
    const int other = ends_at_second ? first : second;
    if (other != kWorld) on_bodies[static_cast<std::size_t>(other)] += on_bodies[leaf];
    open.erase(found);
  }
  return forces;
}

std::vector<BodyPair> touching_pairs(const Scene& scene, BodyColumns bodies) {
  std::set<BodyPair> pairs;
  double least = std::numeric_limits<double>::infinity();
  for (const Body& body : scene.bodies)
    if (body.shape && !body.fixed) least = std::min(least, inradius(*body.shape));
  for_each_near_pair(scene, bodies, kTouching * least, [&](int a, int b, double gap) {
    if (gap > kTouching * least) return;
    const int first = end_of(scene, a), second = end_of(scene, b);
    pairs.insert({std::min(first, second), std::max(first, second)});
  });
  return {pairs.begin(), pairs.end()};
}

std::string why_no_contacts(const JudgedRun& run) {
  if (!anything_can_touch(run.scene)) return "no two bodies of the scene can touch";
  if (!run.trajectory.has_contacts) return "the engine does not report contact forces";
  const std::vector<Sample>& samples = run.trajectory.samples;
  constexpr double kOneStep = 1.5;
  if (samples.size() < 2) return "the run has no finite step";
  if (samples[1].time > kOneStep * run.trajectory.dt) return "steps are not recorded one by one";
  return "";
}

std::optional<PairForces> true_pair_forces(const JudgedRun& run, std::size_t n) {
  const Sample &before = run.trajectory.samples[n - 1], &after = run.trajectory.samples[n];
  const BodyColumns start = run.truth->bodies[n - 1].columns(), end = run.truth->bodies[n].columns();
  std::vector<BodyPair> touching = touching_pairs(run.scene, start);
  const std::vector<BodyPair> at_end = touching_pairs(run.scene, end);
  touching.insert(touching.end(), at_end.begin(), at_end.end());
  return pair_forces_of(touching, forces_on_bodies(run.scene, start, end, before.time, after.time - before.time));
}

std::string name_of(const Scene& scene, const BodyPair& pair) {
  const auto name = [&](int body) { return body == kWorld ? "fixed bodies" : scene.body_name(body); };
  return fmt::format("force of {} on {}", name(pair.first), name(pair.second));
}

}  // namespace rigor
