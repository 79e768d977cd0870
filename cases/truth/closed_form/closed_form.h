// Code shared by closed forms: a scene of fixed bodies and of moving ones, each with its own motion, and the parabola
// of a body under gravity alone. Closed forms compute in extended precision. Their error is the rounding of the result
// to double, plus the error of a phase over many turns.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "cases/truth/truth.h"
#include "core/scene/features/feature.h"

namespace rigor::inline truth {

using Extended = long double;
using ExtendedVec3 = Eigen::Matrix<Extended, 3, 1>;
using ExtendedMat3 = Eigen::Matrix<Extended, 3, 3>;
using ExtendedQuat = Eigen::Quaternion<Extended>;

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
inline constexpr double kExtendedEpsilon = static_cast<double>(std::numeric_limits<Extended>::epsilon());

// Two principal moments count as equal if they differ by less than this share of the largest: some fifty roundings of
// the numbers in a scene's file.
inline constexpr double kEqualMoments = 1e-14;

inline ExtendedVec3 extended(const Vec3& v) { return v.cast<Extended>(); }
inline ExtendedMat3 extended(const Mat3& m) { return m.cast<Extended>(); }
inline ExtendedQuat extended(const Quat& q) { return q.cast<Extended>().normalized(); }

// The unit quaternion of a rotation by the vector `angle` [rad], about its direction, by its length.
ExtendedQuat turn(const ExtendedVec3& angle);

struct ExtendedState {
  ExtendedVec3 position;          // m, p_WB
  ExtendedQuat orientation;       // B to W
  ExtendedVec3 velocity;          // m/s, in W
  ExtendedVec3 angular_velocity;  // rad/s, in W
};

// How one body moves.
class BodyMotion {
 public:
  virtual ~BodyMotion() = default;
  virtual ExtendedState at(Extended t) const = 0;
  // The same as Truth::error, without the rounding of the orientation to double.
  virtual double error(double t) const = 0;
};

// The truth in which each body that is not fixed has the motion that `motion_of` gives it.
std::unique_ptr<Truth> closed_form(const Scene& scene,
                                   const std::function<std::unique_ptr<BodyMotion>(const Body&)>& motion_of);

// Throws InputError unless the scene needs only fixed bodies and features in `allowed`. `is_for` completes
// the sentence: the truth 'bounce' is for <spheres above a plane>.
void check_needs(const Scene& scene, const std::string& truth, const std::string& is_for, const Features& allowed = {});

// p = p0 + v0 t + g t²/2.
class Parabola {
 public:
  Parabola(const Body& body, const Vec3& gravity)
      : start_(extended(body.position)), velocity_(extended(body.velocity)), gravity_(extended(gravity)) {}

  ExtendedVec3 position(Extended t) const { return start_ + t * velocity_ + t * t / 2 * gravity_; }  // m
  ExtendedVec3 velocity(Extended t) const { return velocity_ + t * gravity_; }                       // m/s
  // m; the rounding to double of the farthest that the terms can add up to
  double error(double t) const {
    return kEpsilon * static_cast<double>(start_.norm() + velocity_.norm() * t + gravity_.norm() * t * t / 2);
  }

 private:
  ExtendedVec3 start_, velocity_, gravity_;
};

}  // namespace rigor::inline truth
