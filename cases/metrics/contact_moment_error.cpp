// Resultant moments of pairs against the truth, as far as the equations of motion determine them (equilibrium.h).
//
// contact_moment_error: the difference of the reported moment about the body's centre of mass from the one that the
// truth's motion implies.
//
// centre_of_pressure_error: the distance, along the contact's plane, between the points at which the two resultants
// act. With the plane's normal n and its distance h = n·r from the centre of mass, M = r × F gives
//   r_t = (n × M + h F_t) / (n·F).
// It is the centre of pressure of Sardain and Bessonnet (Forces acting on a biped robot, IEEE Trans. SMC A 34, 2004).
#include "cases/metrics/measures/contact/pair_differences.h"

namespace rigor::inline metric {
namespace {

std::string why_no_moments(const JudgedRun& run) {
  if (any_law(run.scene, [](const ContactLaw& law) { return law.resists_turning(); }))
    return "rolling or torsional friction adds a couple, which engines do not report with their contact forces";
  return why_no_pairs(run);
}

MetricResult measure_moment(const JudgedRun& run) {
  if (const std::string why = why_no_moments(run); !why.empty()) return {{}, why};
  return largest_pair_difference(run, "moment", &DueWrench::moment_counts, [](const PairAtStep& at) {
    const Vec3 found = at.due.moment_counts * at.found.moment, due = at.due.moment_counts * at.due.wrench.moment;
    return std::optional(PairDifference{(found - due).norm(), found.norm(), due.norm()});
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
    if (pair_of(run.scene, contact.a, contact.b) != pair) continue;
    const bool is_on_b = contact.b == pair.second;
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
  if (const std::string why = why_no_moments(run); !why.empty()) return {{}, why};
  return largest_pair_difference(
      run, "centre of pressure", &DueWrench::moment_counts, [&](const PairAtStep& at) -> std::optional<PairDifference> {
        if (!counts_fully(at.due.force_counts) || !counts_fully(at.due.moment_counts)) return std::nullopt;
        const std::optional<Plane3> plane = plane_of(run, at.n, at.pair);
        const PairWrench& due = at.due.wrench;
        if (!plane || !(plane->normal.dot(at.found.force) > 0) || !(plane->normal.dot(due.force) > 0))
          return std::nullopt;
        const double distance = (centre_of_pressure(at.found, *plane) - centre_of_pressure(due, *plane)).norm();
        return PairDifference{distance, distance, 0};
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

}  // namespace rigor::inline metric
