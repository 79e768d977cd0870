#include "cases/metrics/measures/synchronised.h"

#include <algorithm>
#include <cmath>

#include "core/scene/contact_laws.h"

namespace rigor {
namespace {

constexpr double kJump = 2;       // a change of velocity that is so many times its neighbour is an impact
constexpr double kUnlike = 0.1;   // the share of v - d that the change of velocity may leave unexplained
constexpr double kLargeTurn = 2;  // rad between two samples, from which on their orientations do not tell the turn

bool is_jump(const Vec3& change, const Vec3& neighbour) { return change.norm() > kJump * neighbour.norm(); }

bool can_velocities_jump(const Scene& scene) {
  return anything_can_touch(scene) || !scene.motors.empty() ||
         std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) { return joint.has_limits(); });
}

Vec3 turn_between(const Quat& from, const Quat& to) {
  Quat turn = to.normalized() * from.normalized().conjugate();
  if (turn.w() < 0) turn.coeffs() *= -1;
  const double sine = turn.vec().norm();
  return sine > 0 ? Vec3(2 * std::atan2(sine, turn.w()) / sine * turn.vec()) : Vec3::Zero();
}

}  // namespace

Synchroniser::Synchroniser(const Scene& scene, const Trajectory& run, double stagger)
    : scene_(scene), run_(run), can_jump_(can_velocities_jump(scene)), jointed_(scene.bodies.size()) {
  const auto& samples = run.samples;
  if (samples.size() < 2) return;
  spacing_ = samples[1].time - samples[0].time;
  declared_ = stagger * run.dt / spacing_;
  if (declared_ == 0 || scene.joints.empty()) return;
  for (const Joint& joint : scene.joints) {
    for (const int body : {joint.a, joint.b}) {
      if (body != kWorld) jointed_[body] = true;
    }
  }
  lags_.resize(jointed_.size());
  for (std::size_t i = 0; i < jointed_.size(); ++i) {
    if (!jointed_[i] || scene.bodies[i].fixed) continue;
    for (const Rate kind : kRates) lags_[i][static_cast<std::size_t>(kind)] = fitted_lag(kind, i);
  }
}

void Synchroniser::apply(std::size_t n, MutableBodyColumns bodies) const {
  if (declared_ == 0) return;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (scene_.bodies[i].fixed) continue;
    bodies.set_velocity(i, brought_forward(Rate::linear, i, n));
    bodies.set_angular_velocity(i, brought_forward(Rate::angular, i, n));
  }
}

Vec3 Synchroniser::rate(Rate kind, std::size_t i, std::size_t n) const {
  const BodyColumns bodies = run_.samples[n].bodies.columns();
  return kind == Rate::linear ? bodies.velocity(i) : bodies.angular_velocity(i);
}

Vec3 Synchroniser::mean_rate(Rate kind, std::size_t i, std::size_t n) const {
  const BodyColumns before = run_.samples[n - 1].bodies.columns(), now = run_.samples[n].bodies.columns();
  const double h = run_.samples[n].time - run_.samples[n - 1].time;
  return kind == Rate::linear ? Vec3((now.position(i) - before.position(i)) / h)
                              : Vec3(turn_between(before.orientation(i), now.orientation(i)) / h);
}

double Synchroniser::speed_change(Rate kind, std::size_t i, std::size_t n) const {
  return rate(kind, i, n).norm() - rate(kind, i, n - 1).norm();
}

// The last sample of the interval over which the change after the n-th sample is taken; none where impacts on both
// sides leave no acceleration to be seen.
std::optional<std::size_t> Synchroniser::interval_after(Rate kind, std::size_t i, std::size_t n) const {
  const std::size_t last = run_.samples.size() - 1, next = std::min(n + 1, last);
  if (!can_jump_ || last < 2) return next;
  // The interval on the other side; at either end of the run, the only neighbour.
  const std::size_t other = next == 1 ? 2 : next - 1;
  const Vec3 expected = change(kind, i, next), neighbour = change(kind, i, other);
  if (is_jump(expected, neighbour)) return other;
  const bool are_opposed = expected.dot(neighbour) < 0 && !is_jump(neighbour, expected);
  return are_opposed ? std::nullopt : std::optional(next);
}

// `share`: (v - d)/(v_n - v_{n-1}).
double Synchroniser::lag_for(double share) const {
  const double found = 0.5 - share;
  return found > declared_ / 2 ? declared_ : std::max(0.0, found);
}

double Synchroniser::lag(Rate kind, std::size_t i, std::size_t n) const {
  const std::size_t last = run_.samples.size() - 1;
  std::size_t k = std::max<std::size_t>(n, 1);
  if (can_jump_ && k < last && is_jump(change(kind, i, k), change(kind, i, k + 1))) ++k;
  const Vec3 now = rate(kind, i, k), changed = change(kind, i, k), apart = now - mean_rate(kind, i, k);
  if (kind == Rate::angular && spacing_ * now.norm() > kLargeTurn) return declared_;
  if (!(changed.squaredNorm() > 0)) return declared_;
  const double share = apart.dot(changed) / changed.squaredNorm();
  const bool is_explained = (apart - share * changed).norm() <= kUnlike * apart.norm();
  return is_explained && share < 0.5 + kUnlike ? lag_for(share) : declared_;
}

double Synchroniser::fitted_lag(Rate kind, std::size_t i) const {
  double product = 0, square = 0;
  const std::size_t last = run_.samples.size() - 1;
  for (std::size_t n = 1; n <= last; ++n) {
    const Vec3 now = rate(kind, i, n);
    const double speed = now.norm(), changed = speed_change(kind, i, n);
    if (!(speed > 0) || (kind == Rate::angular && spacing_ * speed > kLargeTurn)) continue;
    const auto is_beside = [&](std::size_t k) { return can_jump_ && is_jump(change(kind, i, n), change(kind, i, k)); };
    if ((n > 1 && is_beside(n - 1)) || (n < last && is_beside(n + 1))) continue;
    product += changed * (speed - mean_rate(kind, i, n).dot(now) / speed), square += changed * changed;
  }
  return square > 0 ? lag_for(product / square) : declared_;
}

Vec3 Synchroniser::brought_forward(Rate kind, std::size_t i, std::size_t n) const {
  const Vec3 now = rate(kind, i, n);
  const auto interval = interval_after(kind, i, n);
  if (!interval) return now;
  if (!jointed_[i]) return now + lag(kind, i, n) * change(kind, i, *interval);
  const double speed = now.norm(), lag = lags_[i][static_cast<std::size_t>(kind)];
  if (!(speed > 0)) return now;
  return std::max(0.0, speed + lag * speed_change(kind, i, *interval)) / speed * now;
}

}  // namespace rigor
