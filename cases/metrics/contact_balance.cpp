// The part of each body's change of momentum that its reported contact forces, gravity and timed forces leave
// unexplained, divided by the step: |m dv/dt - m g - f - sum of contact forces|. It uses the run alone, so it says
// whether the reported forces are those that moved the bodies.
#include "cases/metrics/measures/contact/pair_forces.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor {
namespace {

MetricResult measure_balance(const JudgedRun& run) {
  if (const std::string why = why_no_contacts(run); !why.empty()) return {{}, why};
  if (!run.scene.springs.empty() || !run.scene.joints.empty())
    return {{}, "springs or joints act on bodies beside their contacts"};
  TimeSeries series;
  series.add(0, {0, kWorld, "force", 0, 0});
  for (std::size_t n = 1; n < run.trajectory.samples.size(); ++n) {
    const Sample &before = run.trajectory.samples[n - 1], &after = run.trajectory.samples[n];
    const std::vector<Vec3> needed = forces_on_bodies(run.scene, before.bodies.columns(), after.bodies.columns(),
                                                      before.time, after.time - before.time);
    std::vector<Vec3> reported(needed.size(), Vec3::Zero());
    for (const ReportedContact& contact : after.contacts) {
      reported[static_cast<std::size_t>(contact.a)] -= contact.force;
      reported[static_cast<std::size_t>(contact.b)] += contact.force;
    }
    double largest = 0;
    Instant worst{after.time, kWorld, "force", 0, 0};
    for (std::size_t i = 0; i < needed.size(); ++i) {
      if (run.scene.bodies[i].fixed || (needed[i] - reported[i]).norm() <= largest) continue;
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

}  // namespace rigor
