// Resultant moments of pairs against the truth (pair_wrenches.h).
//
// contact_moment_error: the difference of the reported moment about the body's centre of mass from the one that the
// truth's motion implies.
//
// centre_of_pressure_error: the distance, along the contact's plane, between the points at which the two resultants
// act. With the plane's normal n and its distance h = n·r from the centre of mass, M = r × F gives
//   r_t = (n × M + h F_t) / (n·F).
// It is the centre of pressure of Sardain and Bessonnet (Forces acting on a biped robot, IEEE Trans. SMC A 34, 2004).
#include "cases/metrics/measures/contact/pair_wrenches.h"
#include "cases/metrics/measures/measuring.h"

namespace rigor {
namespace {

// The largest value that `of` finds among the pairs of each sample.
template <typename Of>
MetricResult largest_of_pairs(const JudgedRun& run, const char* component, const Of& of) {
  if (const std::string why = why_no_wrenches(run); !why.empty()) return {{}, why};
  const std::size_t count = samples_within(run, kTruthNeededPosition);
  TimeSeries series;
  series.add(0, {0, kWorld, component, 0, 0});
  bool is_any = false;
  for (std::size_t n = 1; n < count; ++n) {
    const std::optional<PairWrenches> expected = true_pair_wrenches(run, n);
    if (!expected) return {{}, kLoopOfContacts};
    PairWrenches found = reported_pair_wrenches(run, n);
    for (const auto& [pair, wrench] : *expected) found.try_emplace(pair);
    double largest = 0;
    Instant worst{run.trajectory.samples[n].time, kWorld, component, 0, 0};
    for (const auto& [pair, wrench] : found) {
      const auto due = expected->find(pair);
      const std::optional<Instant> at = of(n, pair, wrench, due == expected->end() ? PairWrench{} : due->second);
      if (!at) continue;
      is_any = true;
      if (at->found <= largest) continue;
      largest = at->found, worst = *at;
      worst.time = run.trajectory.samples[n].time, worst.body = pair.second;
    }
    series.add(largest, worst);
  }
  if (!is_any) return {{}, "no pair of bodies presses on a plane contact"};
  return {std::move(series).finish(), ""};
}

MetricResult measure_moment(const JudgedRun& run) {
  return largest_of_pairs(
      run, "moment",
      [&](std::size_t, const BodyPair& pair, const PairWrench& found, const PairWrench& due) -> std::optional<Instant> {
        return Instant{0, kWorld, "moment" + name_of(run.scene, pair).substr(5), (found.moment - due.moment).norm(), 0};
      });
}

// A pair's plane: the mean normal of its points, towards the second body, and its distance from that body's centre.
// Points that carry nothing do not count, for engines put them anywhere.
struct Plane3 {
  Vec3 normal = Vec3::Zero();
  double height = 0;  // m
};

std::optional<Plane3> plane_of(const JudgedRun& run, std::size_t n, const BodyPair& pair) {
  const Vec3 centre = run.trajectory.samples[n - 1].bodies.columns().position(static_cast<std::size_t>(pair.second));
  struct Point {
    Vec3 arm, normal;
    double force;
  };
  std::vector<Point> points;
  Vec3 sum = Vec3::Zero();
  double force = 0;
  for (const ReportedContact& contact : run.trajectory.samples[n].contacts) {
    const bool is_on_b = contact.b == pair.second, is_on_a = contact.a == pair.second;
    const int other = is_on_b ? contact.a : contact.b;
    const int end = run.scene.bodies[static_cast<std::size_t>(other)].fixed ? kWorld : other;
    if (!(is_on_a || is_on_b) || end != pair.first) continue;
    const double pressing = contact.force.dot(contact.normal);
    if (!(pressing > 0)) continue;
    points.push_back({contact.point - centre, is_on_b ? contact.normal : Vec3(-contact.normal), pressing});
    sum += pressing * points.back().normal, force += pressing;
  }
  if (points.empty()) return std::nullopt;
  Plane3 plane{sum.normalized(), 0};
  constexpr double kSamePlane = 1e-3;  // of a unit normal: boxes settle askew by less
  for (const Point& point : points) {
    if ((point.normal - plane.normal).norm() > kSamePlane) return std::nullopt;
    plane.height += plane.normal.dot(point.arm) * point.force / force;
  }
  return plane;
}

Vec3 centre_of_pressure(const PairWrench& wrench, const Plane3& plane) {
  const double pressing = plane.normal.dot(wrench.force);
  const Vec3 tangential = wrench.force - pressing * plane.normal;
  return (plane.normal.cross(wrench.moment) + plane.height * tangential) / pressing;
}

MetricResult measure_pressure(const JudgedRun& run) {
  return largest_of_pairs(run, "centre of pressure",
                          [&](std::size_t n, const BodyPair& pair, const PairWrench& found,
                              const PairWrench& due) -> std::optional<Instant> {
                            const std::optional<Plane3> plane = plane_of(run, n, pair);
                            if (!plane || !(plane->normal.dot(found.force) > 0) || !(plane->normal.dot(due.force) > 0))
                              return std::nullopt;
                            return Instant{0, kWorld, "centre of pressure",
                                           (centre_of_pressure(found, *plane) - centre_of_pressure(due, *plane)).norm(),
                                           0};
                          });
}

}  // namespace

MetricRow contact_moment_error() {
  return {
      .name = "contact_moment_error",
      .unit = "N m",
      .summary = "largest difference of a pair's reported contact moment from that which the truth's motion implies",
      .measure = measure_moment,
      .needs = {.truth = true, .contacts = true}};
}

MetricRow centre_of_pressure_error() {
  return {.name = "centre_of_pressure_error",
          .unit = "m",
          .summary = "farthest that a plane contact's resultant acts from where the truth's motion needs it",
          .measure = measure_pressure,
          .needs = {.truth = true, .contacts = true}};
}

}  // namespace rigor
