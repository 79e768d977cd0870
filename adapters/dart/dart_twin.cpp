#include "adapters/dart/dart_twin.h"

#include <algorithm>
#include <cmath>

#include "adapters/common/reduced_twin.h"

namespace rigor::inline adapters {
namespace {

// DART keeps orientations of free bodies and balls as rotation vectors, and writes them again after each step. For
// rotations below 1e-3 rad its exponential map is cut off after the second power (Geometry.cpp: expMapRot). The
// rotation is then too large by a sixth of its third power, so smaller steps have larger errors.
Mat3 exponential(const Vec3& v) {
  constexpr double kSmall = 1e-3;  // rad
  const double angle = v.norm();
  const Mat3 cross = cross_matrix(v);
  if (angle < kSmall) return Mat3::Identity() + cross + 0.5 * cross * cross;
  return matrix_of(rotation_by(v));
}

// The inverse of the exact map, of any matrix near to a turn.
Vec3 logarithm(const Mat3& m) {
  const Vec3 twice_sine(m(2, 1) - m(1, 2), m(0, 2) - m(2, 0), m(1, 0) - m(0, 1));
  const double angle = std::acos(std::clamp(0.5 * (m.trace() - 1), -1.0, 1.0));
  constexpr double kTiny = 1e-6, kLarge = 1;  // rad; near half a turn the sine is a rounding
  if (angle > kLarge) {
    const Eigen::AngleAxisd turn(Quat(m).normalized());
    return turn.angle() * turn.axis();
  }
  return (angle > kTiny ? 0.5 * angle / std::sin(angle) : 0.5) * twice_sine;
}

Quat turned_by_dart(const Quat& from, const Vec3& w, double dt) {
  return Quat(exponential(logarithm(matrix_of(from) * exponential(dt * w)))).normalized();
}

}  // namespace

// DART's springs and dampers of joints are implicit, which this is not.
const Integrator kDartTwin = {
    .name = "dart-twin",
    .summary = "repeats DART's own smooth step, to explain its error",
    .order = 1,
    .symplectic = false,  // the gyroscopic term is explicit
    .leapfrog_stagger = 0.5,
    .default_orientation = "",
    .takes_contact = false,
    .takes_joints = true,
    .lacks = {joint_feature<DistanceJoint>(), Feature::joint_damper, Feature::joint_limit, Feature::joint_loop,
              Feature::joint_spring, Feature::joint_friction, Feature::motor_servo, Feature::motor_speed},
    .twin_of = "dart",
    .make = [](const StepperParts& parts) { return make_reduced_twin(parts, turned_by_dart); },
};

}  // namespace rigor::inline adapters
