#include "cases/metrics/measures/synchronised.h"

#include <algorithm>
#include <cmath>

#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

constexpr double kJump = 2;       // a change of velocity that is so many times its neighbour is an impact
constexpr double kUnlike = 0.1;   // the share of v - d that the change of velocity may leave unexplained
constexpr double kLargeTurn = 2;  // rad between two samples, from which on their orientations do not tell the turn
constexpr double kFlight = 1e-9;  // of the change and the speed: a sum of a run's roundings, far below any impulse

bool is_jump(const Vec3& change, const Vec3& neighbour) { return change.norm() > kJump * neighbour.norm(); }

bool disagree(const Vec3& a, const Vec3& b) { return is_jump(a, b) || is_jump(b, a) || a.dot(b) < 0; }

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
    bodies.set_velocity(i, readings(Rate::linear, i, n).list[0]);
    bodies.set_angular_velocity(i, readings(Rate::angular, i, n).list[0]);
  }
}

void Synchroniser::apply_bounds(std::size_t n, MutableBodyColumns least, MutableBodyColumns most) const {
  if (declared_ == 0) return;
  const BodyColumns now = run_.samples[n].bodies.columns();
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (scene_.bodies[i].fixed) continue;
    const Mat3 rotation = now.rotation(i);
    for (const Rate kind : kRates) {
      const Readings found = readings(kind, i, n);
      const auto by_energy = [&](const Vec3& a, const Vec3& b) {
        return kinetic(kind, i, rotation, a) < kinetic(kind, i, rotation, b);
      };
      const auto [low, high] = std::minmax_element(found.list.begin(), found.list.begin() + found.count, by_energy);
      kind == Rate::linear ? least.set_velocity(i, *low) : least.set_angular_velocity(i, *low);
      kind == Rate::linear ? most.set_velocity(i, *high) : most.set_angular_velocity(i, *high);
    }
  }
}

double Synchroniser::kinetic(Rate kind, std::size_t i, const Mat3& rotation, const Vec3& rate) const {
  const Body& body = scene_.bodies[i];
  if (kind == Rate::linear) return 0.5 * body.mass * rate.squaredNorm();
  const Vec3 rate_B = rotation.transpose() * rate;
  return 0.5 * rate_B.dot(body.inertia * rate_B);
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

// `share`: (v - d)/(v_n - v_{n-1}). The lag has the sign of the declared one, and at most its size.
double Synchroniser::lag_for(double share) const {
  const double found = (0.5 - share) / declared_;
  return found > 0.5 ? declared_ : std::max(0.0, found) * declared_;
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
  const bool is_likely = (0.5 - share) / declared_ > -kUnlike / std::abs(declared_);
  return is_explained && is_likely ? lag_for(share) : declared_;
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

// Whether gravity alone changed the velocity between the samples n - 1 and n.
bool Synchroniser::is_flight(Rate kind, std::size_t i, std::size_t n) const {
  if (kind != Rate::linear || !can_jump_ || n < 1 || n >= run_.samples.size()) return false;
  const Vec3 fallen = spacing_ * scene_.gravity;
  return (change(kind, i, n) - fallen).norm() <= kFlight * (fallen.norm() + rate(kind, i, n).norm());
}

// `interval`: the last sample of the interval that shows the acceleration.
Vec3 Synchroniser::brought_forward(Rate kind, std::size_t i, std::size_t n, double lag, std::size_t interval) const {
  const Vec3 now = rate(kind, i, n);
  if (!jointed_[i]) return now + lag * change(kind, i, interval);
  const double speed = now.norm();
  return speed > 0 ? Vec3(std::max(0.0, speed + lag * speed_change(kind, i, interval)) / speed * now) : now;
}

Synchroniser::Readings Synchroniser::readings(Rate kind, std::size_t i, std::size_t n) const {
  const double lag = jointed_[i] ? lags_[i][static_cast<std::size_t>(kind)] : Synchroniser::lag(kind, i, n);
  const std::size_t last = run_.samples.size() - 1;
  const Vec3 now = rate(kind, i, n);
  Readings found;
  const auto [nearest, other] = intervals_at(n);
  if (!jointed_[i] && (is_flight(kind, i, nearest) || is_flight(kind, i, other))) {
    found.add(now + lag * spacing_ * scene_.gravity);
  } else if (can_jump_ && last >= 2) {
    found = readings_beside_impacts(kind, i, n, lag);
  } else {
    found.add(brought_forward(kind, i, n, lag, nearest));
    // The scene gives the velocities of the start. A damper may brake them at once.
    if (n == 0 && last >= 2 && disagree(change(kind, i, 1), change(kind, i, 2))) found.add(now);
  }
  // A lag below the declared one is an estimate of second order in h, so the velocity as stored is as likely.
  if (std::abs(lag) < std::abs(declared_)) found.add(now);
  return found;
}

// The last samples of the interval that the velocity is brought into, and of the one on the other side. At either end
// of the run, the other one is the only neighbour.
Synchroniser::Intervals Synchroniser::intervals_at(std::size_t n) const {
  const std::size_t last = run_.samples.size() - 1;
  const std::size_t nearest = std::clamp<std::size_t>(declared_ > 0 ? n + 1 : n, 1, last);
  const std::size_t other =
      declared_ > 0 ? (nearest == 1 ? 2 : nearest - 1) : (nearest == last ? last - 1 : nearest + 1);
  return {nearest, other};
}

Synchroniser::Readings Synchroniser::readings_beside_impacts(Rate kind, std::size_t i, std::size_t n,
                                                             double lag) const {
  const auto [nearest, other] = intervals_at(n);
  const Vec3 into = change(kind, i, nearest), beside = change(kind, i, other), now = rate(kind, i, n);
  const bool is_jump_nearest = is_jump(into, beside);
  const bool are_opposed = into.dot(beside) < 0 && !is_jump_nearest && !is_jump(beside, into);
  Readings found;
  if (are_opposed) found.add(now);
  found.add(brought_forward(kind, i, n, lag, is_jump_nearest ? other : nearest));
  if (!disagree(into, beside)) return found;
  if (kind == Rate::linear && !jointed_[i]) found.add(now + lag * spacing_ * scene_.gravity);
  return found;
}

}  // namespace rigor::inline metric
