// The part of each body's change of momentum that its reported contact forces, gravity and timed forces leave
// unexplained, divided by the step: |m dv/dt - m g - f - sum of contact forces|. Bodies that joints or springs hold
// together count as one, whose inner forces cancel; those that are held to the world do not count. The metric uses the
// run alone, so it says whether the reported forces are those that moved the bodies.
#include <algorithm>
#include <numeric>

#include "cases/metrics/measures/contact/pair_forces.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {
namespace {

// By body: the first body of those that are held together, or kWorld for what is held to the world.
std::vector<int> held_together(const Scene& scene) {
  std::vector<int> first(scene.bodies.size());
  std::iota(first.begin(), first.end(), 0);
  const auto join = [&](int a, int b) {
    const auto of = [&](int body) {
      const bool stands = body == kWorld || scene.bodies[static_cast<std::size_t>(body)].fixed;
      return stands ? kWorld : first[static_cast<std::size_t>(body)];
    };
    const int low = std::min(of(a), of(b)), high = std::max(of(a), of(b));
    if (high != kWorld) std::replace(first.begin(), first.end(), high, low);
  };
  for (const Joint& joint : scene.joints) join(joint.a, joint.b);
  for (const Spring& spring : scene.springs) join(spring.a, spring.b);
  return first;
}

// The sums of the groups' forces, each in the place of its first body.
std::vector<Vec3> by_group(const std::vector<Vec3>& forces, const std::vector<int>& first) {
  std::vector<Vec3> sums(forces.size(), Vec3::Zero());
  for (std::size_t i = 0; i < forces.size(); ++i)
    if (first[i] != kWorld) sums[static_cast<std::size_t>(first[i])] += forces[i];
  return sums;
}

std::vector<Vec3> reported_on_bodies(const Sample& sample, std::size_t bodies) {
  std::vector<Vec3> forces(bodies, Vec3::Zero());
  for (const ReportedContact& contact : sample.contacts) {
    forces[static_cast<std::size_t>(contact.a)] -= contact.force;
    forces[static_cast<std::size_t>(contact.b)] += contact.force;
  }
  return forces;
}

MetricResult measure_balance(const JudgedRun& run) {
  if (const std::string why = why_no_contacts(run); !why.empty()) return {{}, why};
  const std::vector<int> first = held_together(run.scene);
  const std::vector<Body>& bodies = run.scene.bodies;
  bool is_any = false;
  for (std::size_t i = 0; i < bodies.size(); ++i) is_any = is_any || (!bodies[i].fixed && first[i] != kWorld);
  if (!is_any) return {{}, "joints or springs hold every body to the world"};
  TimeSeries series;
  series.add(0, {0, kWorld, "force", 0, 0});
  for (std::size_t n = 1; n < run.trajectory.samples.size(); ++n) {
    const Sample &before = run.trajectory.samples[n - 1], &after = run.trajectory.samples[n];
    const std::vector<Vec3> needed =
        by_group(forces_on_bodies(run.scene, before.bodies.columns(), after.bodies.columns(), before.time,
                                  after.time - before.time),
                 first);
    const std::vector<Vec3> reported = by_group(reported_on_bodies(after, bodies.size()), first);
    double largest = 0;
    Instant worst{after.time, kWorld, "force", 0, 0};
    for (std::size_t i = 0; i < needed.size(); ++i) {
      if (bodies[i].fixed || (needed[i] - reported[i]).norm() <= largest) continue;
      largest = (needed[i] - reported[i]).norm();
      worst = {after.time, static_cast<int>(i), "sum of contact forces", reported[i].norm(), needed[i].norm()};
    }
    series.add(largest, worst);
  }
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow contact_balance() {
  return {.name = "contact_balance",
          .unit = "N",
          .summary = "largest force on a body that its reported contacts and loads leave unexplained",
          .measure = measure_balance,
          .needs = {.contacts = true}};
}

}  // namespace rigor::inline metric
