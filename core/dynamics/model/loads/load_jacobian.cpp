#include "core/dynamics/model/loads/load_jacobian.h"

namespace rigor::inline dynamics {
namespace {

// d (force on b's point) = -by_distance d(d) - by_speed d(d'), with d the vector from a's point to b's:
// With k the slope of the spring's law:
//   by_distance = k n nᵀ + (T/l) P + c n (d'ᵀ P)/l,   by_speed = c n nᵀ,   P = I - n nᵀ,   T the tension.
struct SpringStiffness {
  Vec3 force = Vec3::Zero();  // N, on b's point
  Mat3 by_distance = Mat3::Zero(), by_speed = Mat3::Zero();
};

SpringStiffness stiffness_of(const Spring& spring, const PointMotion& a, const PointMotion& b) {
  const Vec3 line = b.position - a.position, speed = b.velocity - a.velocity;
  const double length = line.norm();
  if (length == 0) return {};
  const Vec3 n = line / length;
  const Mat3 along = n * n.transpose(), across = Mat3::Identity() - along;
  const double extension = length - spring.rest_length;
  const double tension = elastic_effort(spring, extension) + spring.damping * n.dot(speed);
  return {-tension * n,
          stiffness_at(spring, extension) * along + tension / length * across +
              spring.damping / length * n * (speed.transpose() * across),
          spring.damping * along};
}

// How a point moves with its body: d(point) = by_pose d(pose), d(velocity) = rate_by_pose d(pose) + by_pose d(v, w).
struct PointDerivative {
  Eigen::Matrix<double, 3, 6> by_pose, rate_by_pose;
};

PointDerivative derivative_of(const PointMotion& point, const Vec3& w) {
  PointDerivative d;
  const Mat3 arm = cross_matrix(point.arm);
  d.by_pose << Mat3::Identity(), -arm;
  d.rate_by_pose << Mat3::Zero(), -cross_matrix(w) * arm;
  return d;
}

struct End {
  int body;
  double sign;  // of its share in d: -1 for a, +1 for b
  PointMotion point;
};

// The wrench of a force at an end, of which `force_by` is the derivative.
Mat6 wrench_by(const End& end, const Eigen::Matrix<double, 3, 6>& force_by) {
  Mat6 m;
  m << force_by, cross_matrix(end.point.arm) * force_by;
  return m;
}

// A force fixed in W has a torque that changes as its arm turns: d tau = [f]x [arm]x d theta.
Mat6 turning_arm(const Vec3& force, const Vec3& arm) {
  Mat6 m = Mat6::Zero();
  m.bottomRightCorner<3, 3>() = cross_matrix(force) * cross_matrix(arm);
  return m;
}

void visit_spring(const Spring& spring, BodyColumns bodies, const std::function<void(const WrenchDerivative&)>& visit) {
  const End ends[] = {{spring.a, -1, point_motion(bodies, spring.a, spring.point_a)},
                      {spring.b, +1, point_motion(bodies, spring.b, spring.point_b)}};
  const SpringStiffness k = stiffness_of(spring, ends[0].point, ends[1].point);
  for (const End& on : ends) {
    if (on.body == kWorld) continue;
    for (const End& by : ends) {
      if (by.body == kWorld) continue;
      const PointDerivative moved = derivative_of(by.point, bodies.angular_velocity(by.body));
      const double sign = -on.sign * by.sign;
      WrenchDerivative block{static_cast<std::size_t>(on.body), static_cast<std::size_t>(by.body),
                             wrench_by(on, sign * (k.by_distance * moved.by_pose + k.by_speed * moved.rate_by_pose)),
                             wrench_by(on, sign * k.by_speed * moved.by_pose)};
      if (&on == &by) block.by_pose += turning_arm(on.sign * k.force, on.point.arm);
      visit(block);
    }
  }
}

}  // namespace

void visit_load_jacobian(const Loads& loads, BodyColumns bodies, double t, double dt,
                         const std::function<void(const WrenchDerivative&)>& visit) {
  for (const Spring& spring : loads.springs()) visit_spring(spring, bodies, visit);
  loads.for_each_acting(t, dt, [&](const TimedForce& force, double share) {
    const auto body = static_cast<std::size_t>(force.body);
    const Vec3 arm = bodies.rotation(body) * force.point;
    visit({body, body, turning_arm(share * force.force, arm), Mat6::Zero()});
  });
}

}  // namespace rigor::inline dynamics
