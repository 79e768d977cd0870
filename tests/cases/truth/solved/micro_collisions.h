// One box on the plane z = 0 by impacts alone (Mirtich, Impulse-based dynamic simulation of rigid body systems, 1996).
// The box flies freely. A corner that meets the plane gets an impulse, after which it separates with at least the `hop`
// [m/s]. Rest, sliding and rolling consist of such small impacts, so there are no forces, modes or persistent contacts
// that could be wrong. The error is of first order in the hop. Several corners at once: those that approach get their
// impulses together, then those that these push down, and so on. It shares no code with the code under test.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <numbers>
#include <vector>

namespace rigor::test {

class MicroCollisions {
 public:
  using Vec3 = Eigen::Vector3d;
  using Mat3 = Eigen::Matrix3d;

  struct Box {
    double mass;  // kg
    Vec3 half;    // m
    double gravity, friction, restitution;
  };
  struct Motion {
    Vec3 x, v, L;  // m, m/s, kg m²/s about the centre, in W
    Eigen::Quaterniond q;
  };

  MicroCollisions(const Box& box, double hop) : box_(box), hop_(hop) {
    const Vec3 squares = 4 * box.half.cwiseProduct(box.half);
    inertia_ = box.mass / 12 * (Vec3::Constant(squares.sum()) - squares);
    for (int k = 0; k < 8; ++k)
      corners_[k] = box.half.cwiseProduct(Vec3(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
  }

  Vec3 momentum(const Eigen::Quaterniond& q, const Vec3& w) const {
    return q * Vec3(inertia_.cwiseProduct(q.conjugate() * w));
  }

  void advance(Motion& motion, double dt) const {
    constexpr double kLongest = 2.5e-4;  // s: of a step of fourth order, whose error is a rounding
    for (double done = 0; done < dt * (1 - 1e-14);) done += to_next_blow(motion, std::min(kLongest, dt - done));
  }

 private:
  static constexpr double kTouching = 1e-8;  // m: a hop of 1e-4 m/s is 5e-10 m high

  struct Blow {
    Vec3 arm;
    Mat3 inverse_mass;
    double target;  // m/s
    Vec3 impulse = Vec3::Zero();
  };

  Vec3 spin(const Motion& motion) const {
    return motion.q * Vec3((motion.q.conjugate() * motion.L).cwiseQuotient(inertia_));
  }
  Vec3 speed(const Motion& motion, const Vec3& arm) const { return motion.v + spin(motion).cross(arm); }
  double height(const Motion& motion, int k) const { return motion.x.z() + (motion.q * corners_[k]).z(); }

  // The attitude by the classical Runge–Kutta method, with L kept.
  Motion flown(Motion motion, double h) const {
    motion.x += h * motion.v - Vec3(0, 0, 0.5 * box_.gravity * h * h);
    motion.v.z() -= box_.gravity * h;
    const auto rate = [&](const Eigen::Vector4d& at) {
      Motion there = motion;
      there.q.coeffs() = at;
      Eigen::Quaterniond half_turn(0, 0, 0, 0);
      half_turn.vec() = 0.5 * spin(there);
      return Eigen::Vector4d((half_turn * there.q).coeffs());
    };
    const Eigen::Vector4d q = motion.q.coeffs(), k1 = rate(q), k2 = rate(q + 0.5 * h * k1), k3 = rate(q + 0.5 * h * k2),
                          k4 = rate(q + h * k3);
    motion.q.coeffs() = (q + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)).normalized();
    return motion;
  }

  // Over h, or to the first corner that meets the plane before, and its blow. Returns how far.
  double to_next_blow(Motion& motion, double h) const {
    const Motion end = flown(motion, h);
    bool meets = false;
    for (int k = 0; k < 8; ++k) {
      if (height(end, k) >= 0) continue;
      meets = true;
      h = std::min(h, meeting(motion, k, h));
    }
    motion = flown(motion, h);
    if (meets) collide(motion);
    return h;
  }

  // Relative to the height divided by the time; a corner that has just left the plane has only one root.
  double meeting(const Motion& motion, int k, double latest) const {
    constexpr double kSoonest = 1e-10;  // s
    const auto rate = [&](double t) { return height(flown(motion, t), k) / t; };
    const double soon = rate(kSoonest), late = rate(latest);
    if (late >= 0) return latest;
    if (soon <= 0) return kSoonest;
    std::uintmax_t most = 100;
    const auto is_enough = [](double a, double b) { return b - a <= 1e-16 + 4e-16 * b; };
    return boost::math::tools::toms748_solve(rate, kSoonest, latest, soon, late, is_enough, most).first;
  }

  std::vector<Blow> blows(const Motion& motion) const {
    const Mat3 R = motion.q.toRotationMatrix();
    const Mat3 inverse_inertia = R * inertia_.cwiseInverse().asDiagonal() * R.transpose();
    std::vector<Blow> found;
    for (int k = 0; k < 8; ++k) {
      const Vec3 r = motion.q * corners_[k];
      const double u = speed(motion, r).z();
      if (height(motion, k) > kTouching || u >= 0) continue;
      Mat3 across;
      across << 0, -r.z(), r.y(), r.z(), 0, -r.x(), -r.y(), r.x(), 0;
      found.push_back(
          {r, Mat3::Identity() / box_.mass - across * inverse_inertia * across, std::max(-box_.restitution * u, hop_)});
    }
    return found;
  }

  void collide(Motion& motion) const {
    constexpr int kMostRounds = 200, kMostSweeps = 500;
    for (int round = 0; round < kMostRounds; ++round) {
      std::vector<Blow> of_round = blows(motion);
      if (of_round.empty()) return;
      double change = 1;
      for (int sweep = 0; sweep < kMostSweeps && change > 1e-12; ++sweep) {
        change = 0;
        for (Blow& blow : of_round) {
          const Vec3 free = speed(motion, blow.arm) - blow.inverse_mass * blow.impulse;
          const Vec3 impulse = free.z() < blow.target ? impulse_of(blow, free) : Vec3(Vec3::Zero());
          const Vec3 more = impulse - blow.impulse;
          motion.v += more / box_.mass, motion.L += blow.arm.cross(more), blow.impulse = impulse;
          change = std::max(change, (blow.inverse_mass * more).norm());
        }
      }
    }
  }

  // Newton's law of restitution and Coulomb's of friction, of a corner that would have the velocity u without it.
  Vec3 impulse_of(const Blow& blow, const Vec3& u) const {
    const Vec3 p = blow.inverse_mass.ldlt().solve(Vec3(0, 0, blow.target) - u);
    return p.z() > 0 && p.head<2>().norm() <= box_.friction * p.z() ? p : sliding_impulse(blow, u);
  }

  // The direction of friction is the one that the slip it leaves is against: a root over all directions.
  Vec3 sliding_impulse(const Blow& blow, const Vec3& u) const {
    constexpr int kDirections = 48, kHalvings = 52;
    const auto along = [&](double angle) {
      const Vec3 d(box_.friction * std::cos(angle), box_.friction * std::sin(angle), 1);
      return Vec3((blow.target - u.z()) / blow.inverse_mass.row(2).dot(d) * d);
    };
    const auto slip = [&](double angle) { return Vec3(u + blow.inverse_mass * along(angle)); };
    const auto is_left = [&](double angle) {
      return slip(angle).x() * std::sin(angle) < slip(angle).y() * std::cos(angle);
    };
    for (int i = 0; i < kDirections; ++i) {
      double low = 2 * std::numbers::pi * i / kDirections, high = 2 * std::numbers::pi * (i + 1) / kDirections;
      const bool at_low = is_left(low);
      if (at_low == is_left(high)) continue;
      for (int k = 0; k < kHalvings; ++k) (is_left(0.5 * (low + high)) == at_low ? low : high) = 0.5 * (low + high);
      if (slip(low).dot(along(low)) - slip(low).z() * along(low).z() < 0) return along(low);
    }
    return Vec3::Zero();
  }

  Box box_;
  double hop_;
  Vec3 inertia_;
  std::array<Vec3, 8> corners_;
};

}  // namespace rigor::test
