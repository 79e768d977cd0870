#include "core/dynamics/contact/impulse/rebounds/impact_round.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline dynamics {
namespace {

constexpr int kMostSweeps = 200;
constexpr double kSettled = 1e-13;   // of the fastest velocity that a sweep changes
constexpr double kNoEnergy = 1e-14;  // of that exchanged: rounding

Vec3 velocity(const Impact& impact, const std::vector<BodyTwist>& motions) {
  const Vec3 u = relative_velocity(impact.a, impact.b, motions) + impact.shift;
  return {impact.directions[0].dot(u), impact.directions[1].dot(u), impact.directions[2].dot(u)};
}

void set_impulse(Impact& impact, const Vec3& impulse, std::vector<BodyTwist>& motions) {
  const Vec3 change = impulse - impact.impulse;
  if (change.isZero(0)) return;
  for (const double sign : {1.0, -1.0}) {
    const ImpactEnd& end = sign > 0 ? impact.a : impact.b;
    if (end.inverse_mass == 0) continue;
    BodyTwist& motion = motions[static_cast<std::size_t>(end.body)];
    for (int d = 0; d < 3; ++d) {
      motion.v += sign * change[d] * end.inverse_mass * impact.directions[d];
      motion.w += sign * change[d] * end.angular[d];
    }
  }
  impact.impulse = impulse;
}

// Returns by how much it changes the normal velocity.
double solve(Impact& impact, double wanted, std::vector<BodyTwist>& motions) {
  const double old = impact.impulse.x();
  const double p = std::max(0.0, old + (wanted - velocity(impact, motions).x()) * impact.mass);
  set_impulse(impact, {p, impact.impulse.y(), impact.impulse.z()}, motions);
  if (impact.friction > 0) {
    const Vec2 slip = velocity(impact, motions).tail<2>();
    const double radius = p > 0 ? impact.friction * p : 0;  // of infinite friction infinite
    const Vec2 across = onto_disc(impact.impulse.tail<2>(), slip, impact.tangent_mass, radius);
    set_impulse(impact, {p, across.x(), across.y()}, motions);
  }
  return std::abs(p - old) / impact.mass;
}

void sweep(std::vector<Impact>& impacts, double Impact::*wanted, std::vector<BodyTwist>& motions) {
  double fastest = 0;
  for (int count = 0; count < kMostSweeps; ++count) {
    double change = 0;
    for (Impact& impact : impacts) change = std::max(change, solve(impact, impact.*wanted, motions));
    fastest = std::max(fastest, change);
    if (change <= kSettled * fastest) return;
  }
}

// The work of the impulses on the points, half before and half after: the change of kinetic energy [J]. It applies to
// impulses between `from` and the present ones, whose velocities also lie between.
struct Work {
  const std::vector<Impact>& impacts;
  const std::vector<Vec3>&from, &velocities_from, &velocities;
  double operator()(double share) const {
    double sum = 0;
    for (std::size_t i = 0; i < impacts.size(); ++i) {
      const Vec3 p = from[i] + share * (impacts[i].impulse - from[i]);
      const Vec3 u = velocities_from[i] + share * (velocities[i] - velocities_from[i]);
      sum += 0.5 * p.dot(impacts[i].before + u);
    }
    return sum;
  }
};

std::vector<Vec3> velocities_of(const std::vector<Impact>& impacts, const std::vector<BodyTwist>& motions) {
  std::vector<Vec3> all;
  for (const Impact& impact : impacts) all.push_back(velocity(impact, motions));
  return all;
}

std::vector<Vec3> impulses_of(const std::vector<Impact>& impacts) {
  std::vector<Vec3> all;
  for (const Impact& impact : impacts) all.push_back(impact.impulse);
  return all;
}

// The root in [0, 1] of the parabola through its values at 0, 1/2 and 1, of which the last is positive.
double root_of(double at_0, double at_half, double at_1) {
  if (at_0 >= 0) return 0;
  const double a = 2 * (at_1 + at_0 - 2 * at_half), b = at_1 - at_0 - a;
  return std::clamp(-2 * at_0 / (b + std::sqrt(std::max(0.0, b * b - 4 * a * at_0))), 0.0, 1.0);
}

// Back from the impulses that are there, which add energy, towards those without restitution.
void take_back(std::vector<Impact>& impacts, std::vector<BodyTwist>& motions) {
  const std::vector<Vec3> with = impulses_of(impacts), velocities_with = velocities_of(impacts, motions);
  for (Impact& impact : impacts) set_impulse(impact, Vec3::Zero(), motions);
  sweep(impacts, &Impact::wanted_without, motions);
  const std::vector<Vec3> velocities = velocities_of(impacts, motions);
  const Work work{impacts, with, velocities_with, velocities};
  const double back = 1 - root_of(work(1), work(0.5), work(0));
  for (std::size_t i = 0; i < impacts.size(); ++i)
    set_impulse(impacts[i], with[i] + back * (impacts[i].impulse - with[i]), motions);
}

}  // namespace

Vec3 relative_velocity(const ImpactEnd& a, const ImpactEnd& b, const std::vector<BodyTwist>& motions) {
  const auto velocity_of = [&](const ImpactEnd& end) -> Vec3 {
    const BodyTwist& motion = motions[static_cast<std::size_t>(end.body)];
    return motion.v + motion.w.cross(end.arm);
  };
  return velocity_of(a) - velocity_of(b);
}

void prepare(Impact& impact) {
  const auto K = [&](int d, int by) {
    double sum = d == by ? impact.a.inverse_mass + impact.b.inverse_mass : 0;
    for (const ImpactEnd* end : {&impact.a, &impact.b})
      sum += impact.directions[d].dot(end->angular[by].cross(end->arm));
    return sum;
  };
  impact.mass = 1 / K(0, 0);
  impact.tangent_mass = tangent_mass_of(K(1, 1), K(2, 2), K(1, 2));
}

void solve_round(std::vector<Impact>& impacts, std::vector<BodyTwist>& motions) {
  double exchanged = 0;
  for (Impact& impact : impacts) impact.before = velocity(impact, motions);
  sweep(impacts, &Impact::wanted, motions);
  const std::vector<Vec3> none(impacts.size(), Vec3::Zero()), velocities = velocities_of(impacts, motions);
  for (const Impact& impact : impacts) exchanged += std::abs(impact.impulse.dot(impact.before));
  if (Work{impacts, none, none, velocities}(1) > kNoEnergy * exchanged) take_back(impacts, motions);
}

}  // namespace rigor::inline dynamics
