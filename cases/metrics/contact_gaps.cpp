// Gaps of contacts, against the judge's own geometry.
//
// contact_gap_error: the difference of a pair's least reported gap from the distance of its surfaces at the step's
// start, where engines look for contacts. A method that meets contacts inside a step differs by what bodies approach in
// a step.
//
// hover: the mean gap under load. For each pair, sum(f g) / sum(f) over the run's steps, with f the size of its
// reported force and g >= 0 the gap between the two surfaces at the step's end, by the judge's own geometry. Rigid
// bodies press only where they touch. A body that slides on a friction whose velocity is regularised or linearised with
// the normal one rides above the ground by dt mu v (Tasora, Anitescu, A convex complementarity approach for simulating
// large granular flows, J. Comput. Nonlinear Dyn. 5, 2010).
#include "cases/metrics/measures/contact/pair_forces.h"
#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/shape_gap.h"

namespace rigor::inline metric {
namespace {

struct Load {
  double force = 0, moment = 0;  // N and N m: the sums of f and of f g
};

double gap_of(const Scene& scene, BodyColumns bodies, const BodyPair& pair) {
  const auto pose = [&](int body) {
    const auto i = static_cast<std::size_t>(body);
    return BodyPose{bodies.position(i), bodies.orientation(i).normalized()};
  };
  const auto& first = scene.bodies[static_cast<std::size_t>(pair.first)];
  const auto& second = scene.bodies[static_cast<std::size_t>(pair.second)];
  return shape_gap(*first.shape, pose(pair.first), *second.shape, pose(pair.second));
}

BodyPair pair_of(const ReportedContact& contact) {
  return {std::min(contact.a, contact.b), std::max(contact.a, contact.b)};
}

MetricResult measure_gap_error(const JudgedRun& run) {
  if (const std::string why = why_no_contacts(run); !why.empty()) return {{}, why};
  TimeSeries series;
  series.add(0, {0, kWorld, "gap", 0, 0});
  for (std::size_t n = 1; n < run.trajectory.samples.size(); ++n) {
    const Sample& sample = run.trajectory.samples[n];
    std::map<BodyPair, double> reported;
    for (const ReportedContact& contact : sample.contacts) {
      double& least = reported.try_emplace(pair_of(contact), contact.gap).first->second;
      least = std::min(least, contact.gap);
    }
    double largest = 0;
    Instant worst{sample.time, kWorld, "gap", 0, 0};
    for (const auto& [pair, gap] : reported) {
      const double due = gap_of(run.scene, run.trajectory.samples[n - 1].bodies.columns(), pair);
      if (std::abs(gap - due) <= largest) continue;
      largest = std::abs(gap - due);
      worst = {sample.time, pair.second, "gap", gap, due};
    }
    series.add(largest, worst);
  }
  return {std::move(series).finish(), ""};
}

// Adds each pair's force at a sample, and its moment over the gap there.
void add_loads(const Scene& scene, const Sample& sample, std::map<BodyPair, Load>& loads) {
  const BodyColumns bodies = sample.bodies.columns();
  std::map<BodyPair, Vec3> forces;
  for (const ReportedContact& contact : sample.contacts) {
    const BodyPair pair = pair_of(contact);
    const Vec3 on_second = contact.b == pair.second ? contact.force : Vec3(-contact.force);
    forces.try_emplace(pair, Vec3::Zero()).first->second += on_second;
  }
  for (const auto& [pair, force] : forces) {
    const double gap = gap_of(scene, bodies, pair);
    Load& load = loads[pair];
    load.force += force.norm(), load.moment += force.norm() * std::max(0.0, gap);
  }
}

MetricResult measure_hover(const JudgedRun& run) {
  if (const std::string why = why_no_contacts(run); !why.empty()) return {{}, why};
  std::map<BodyPair, Load> loads;
  for (const Sample& sample : run.trajectory.samples) add_loads(run.scene, sample, loads);
  const double end = run.trajectory.samples.back().time;
  double largest = 0;
  Instant worst{end, kWorld, "gap under load", 0, 0};
  for (const auto& [pair, load] : loads) {
    if (!(load.moment > largest * load.force)) continue;
    largest = load.moment / load.force;
    worst = {end, pair.second, "gap under load", largest, 0};
  }
  TimeSeries series;
  series.add(largest, worst);
  return {std::move(series).finish(), ""};
}

}  // namespace

MetricRow contact_gap_error() {
  return {.name = "contact_gap_error",
          .unit = "m",
          .summary = "largest difference of a pair's least reported gap from the distance of its surfaces",
          .measure = measure_gap_error,
          .needs = {.contacts = true}};
}

MetricRow hover() {
  return {.name = "hover",
          .unit = "m",
          .summary = "mean gap, weighted by the force, of a pair that reports a contact force across it",
          .measure = measure_hover,
          .needs = {.contacts = true}};
}

}  // namespace rigor::inline metric
