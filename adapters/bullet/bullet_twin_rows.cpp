#include "adapters/bullet/bullet_twin_rows.h"

#include <cmath>
#include <limits>

namespace rigor::inline adapters {
namespace {

Vec6 both(const Vec3& linear, const Vec3& angular) {
  Vec6 out;
  out << linear, angular;
  return out;
}

// b turns against a about the axis.
ConstraintRow turn_row(const Vec3& axis, double gap) {
  return {both(Vec3::Zero(), -axis), both(Vec3::Zero(), axis), gap, 0};
}

// The point at arm_b moves against that at arm_a along the axis.
ConstraintRow linear_row(const Vec3& axis, const Vec3& arm_a, const Vec3& arm_b, double gap) {
  return {both(-axis, -arm_a.cross(axis)), both(axis, arm_b.cross(axis)), gap, 0};
}

// A frame that both share at t = 0.
class Frames {
 public:
  Frames(const BulletEnd& a, const BulletEnd& b, const Vec3& origin_W, const Mat3& axes_W)
      : arm_a_(a.R.transpose() * (origin_W - a.position)),
        arm_b_(b.R.transpose() * (origin_W - b.position)),
        axes_a_(a.R.transpose() * axes_W),
        axes_b_(b.R.transpose() * axes_W) {}

  struct Now {
    Vec3 arm_a, arm_b;  // m, of the frame's origin, in W
    Mat3 of_a, of_b;    // its axes as each end has them, in W
    Vec3 apart;         // m, from a's origin of it to b's
    double share_a;     // of b's inverse mass in the sum of both: what Bullet weighs a with
    bool has_static;
  };
  Now now(const BulletEnd& a, const BulletEnd& b) const {
    Now now{a.R * arm_a_, b.R * arm_b_, a.R * axes_a_, b.R * axes_b_, Vec3::Zero(), 0, false};
    now.apart = b.position + now.arm_b - a.position - now.arm_a;
    now.share_a = b.inverse_mass / (a.inverse_mass + b.inverse_mass);
    constexpr double kStatic = std::numeric_limits<double>::epsilon();
    now.has_static = a.inverse_mass < kStatic || b.inverse_mass < kStatic;
    return now;
  }

 private:
  Vec3 arm_a_, arm_b_;
  Mat3 axes_a_, axes_b_;
};

class Ball : public BulletJointRows {
 public:
  explicit Ball(const Frames& frames) : frames_(frames) {}
  void add_to(std::vector<ConstraintRow>& rows, const BulletEnd& a, const BulletEnd& b) const override {
    const Frames::Now now = frames_.now(a, b);
    for (int k = 0; k < 3; ++k) rows.push_back(linear_row(Vec3::Unit(k), now.arm_a, now.arm_b, now.apart[k]));
  }

 private:
  Frames frames_;
};

// z is the axis. Its angle to b's is taken as its sine.
class Hinge : public BulletJointRows {
 public:
  explicit Hinge(const Frames& frames) : frames_(frames) {}
  void add_to(std::vector<ConstraintRow>& rows, const BulletEnd& a, const BulletEnd& b) const override {
    const Frames::Now now = frames_.now(a, b);
    const Vec3 tilt = now.of_a.col(2).cross(now.of_b.col(2));
    for (int k = 0; k < 3; ++k) rows.push_back(linear_row(Vec3::Unit(k), now.arm_a, now.arm_b, now.apart[k]));
    for (int k = 0; k < 2; ++k) rows.push_back(turn_row(now.of_a.col(k), tilt.dot(now.of_a.col(k))));
  }

 private:
  Frames frames_;
};

// btGeneric6DofSpring2Constraint with locked displacements along a's axes, and some of the three angles from a's axes
// to b's locked, about a's z first and b's x last.
class SixCoordinates : public BulletJointRows {
 public:
  SixCoordinates(const Frames& frames, bool keeps_all_angles) : frames_(frames), keeps_all_angles_(keeps_all_angles) {}
  void add_to(std::vector<ConstraintRow>& rows, const BulletEnd& a, const BulletEnd& b) const override {
    const Frames::Now now = frames_.now(a, b);
    const Mat3 turn = now.of_a.transpose() * now.of_b;
    const Vec3 angles(std::atan2(turn(2, 1), turn(2, 2)), -std::asin(turn(2, 0)), std::atan2(turn(1, 0), turn(0, 0)));
    const Vec3 last = now.of_b.col(0), first = now.of_a.col(2), node = first.cross(last);
    const Vec3 axes[] = {node.cross(first).normalized(), node.normalized(), last.cross(node).normalized()};
    for (int k = 0; k < 3; ++k)
      if (keeps(k)) rows.push_back(turn_row(axes[k], angles[k]));
    for (int k = 0; k < 3; ++k) {
      const double share_a = frees_arms(now, angles, k) ? now.share_a : 1;
      const double share_b = frees_arms(now, angles, k) ? 1 - now.share_a : 1;
      const Vec3 axis = now.of_a.col(k);
      rows.push_back(linear_row(axis, share_a * now.arm_a, share_b * now.arm_b, axis.dot(now.apart)));
    }
  }

 private:
  bool keeps(int angle) const { return keeps_all_angles_ || angle == 1; }
  // Bullet lets a static end's partner off its arm where both other angles are far off.
  bool frees_arms(const Frames::Now& now, const Vec3& angles, int axis) const {
    constexpr double kFarOff = 1e-3;  // rad
    const auto is_off = [&](int k) { return keeps(k) && std::abs(angles[k]) > kFarOff; };
    return now.has_static && is_off((axis + 1) % 3) && is_off((axis + 2) % 3);
  }

  Frames frames_;
  bool keeps_all_angles_;
};

// x is the axis. Both ends are pushed at one point, which the masses share out, so that no couple arises however far b
// has come. The row that keeps the turn about the axis is missing where that turn is exactly zero, and of a cylindrical
// joint always.
class Slider : public BulletJointRows {
 public:
  Slider(const Frames& frames, bool keeps_turn) : frames_(frames), keeps_turn_(keeps_turn) {}
  void add_to(std::vector<ConstraintRow>& rows, const BulletEnd& a, const BulletEnd& b) const override {
    const Frames::Now now = frames_.now(a, b);
    const Vec3 on_a = now.of_a.col(0), on_b = now.of_b.col(0);
    const Vec3 axis = (now.share_a * on_a + (1 - now.share_a) * on_b).normalized();
    const double turned =
        keeps_turn_ ? std::atan2(now.of_b.col(1).dot(now.of_a.col(2)), now.of_b.col(1).dot(now.of_a.col(1))) : 0;
    add_ways(rows, now, axis, turned != 0);
    const Across across = directions_across(axis);
    const Vec3 tilt = on_a.cross(on_b);
    for (const Vec3& direction : {across.first, across.second})
      rows.push_back(turn_row(direction, tilt.dot(direction)));
    if (turned != 0) rows.push_back(turn_row(axis, turned));
  }

 private:
  static void add_ways(std::vector<ConstraintRow>& rows, const Frames::Now& now, const Vec3& axis, bool is_turned) {
    const double share_a = now.share_a, share_b = 1 - now.share_a;
    const Vec3 along_a = axis.dot(now.arm_a) * axis, along_b = axis.dot(now.arm_b) * axis;
    const Vec3 across_a = now.arm_a - along_a, across_b = now.arm_b - along_b;
    const Vec3 between = along_a + now.of_a.col(0).dot(now.apart) * axis - along_b;
    const Vec3 arm_a = across_a + share_a * between, arm_b = across_b - share_b * between;
    Vec3 first = share_a * across_b + share_b * across_a;
    const bool has_direction = first.squaredNorm() > std::numeric_limits<double>::epsilon();
    first = has_direction ? first.normalized() : Vec3(now.of_a.col(1));
    const Vec3 second = axis.cross(first);
    rows.push_back(linear_row(first, arm_a, arm_b, first.dot(now.apart)));
    const bool frees = now.has_static && is_turned;
    rows.push_back(
        linear_row(second, (frees ? share_a : 1) * arm_a, (frees ? share_b : 1) * arm_b, second.dot(now.apart)));
  }

  Frames frames_;
  bool keeps_turn_;
};

BulletEnd end_at_start(const Scene& scene, int body) {
  if (body == kWorld || scene.bodies[static_cast<std::size_t>(body)].fixed) return {};
  const BodyPose pose = scene.pose(body);
  return {pose.position, matrix_of(pose.orientation), 1 / scene.bodies[static_cast<std::size_t>(body)].mass};
}

struct MakeRows {
  BulletEnd a, b;
  Vec3 center_b;  // m, in W

  Frames frames(const Vec3& origin, const Mat3& axes) const { return {a, b, origin, axes}; }
  static Mat3 axes(const Vec3& x, const Vec3& z) {
    Mat3 axes;
    axes << x, z.cross(x), z;
    return axes;
  }

  std::unique_ptr<BulletJointRows> operator()(const BallJoint& joint) const {
    return std::make_unique<Ball>(frames(joint.anchor, Mat3::Identity()));
  }
  std::unique_ptr<BulletJointRows> operator()(const HingeJoint& joint) const {
    return std::make_unique<Hinge>(frames(joint.anchor, axes(joint.axis.unitOrthogonal(), joint.axis)));
  }
  std::unique_ptr<BulletJointRows> operator()(const SliderJoint& joint) const {
    return slider(center_b, joint.axis, true);
  }
  std::unique_ptr<BulletJointRows> operator()(const FixedJoint&) const {
    return std::make_unique<SixCoordinates>(frames(center_b, Mat3::Identity()), true);
  }
  std::unique_ptr<BulletJointRows> operator()(const UniversalJoint& joint) const {
    const Vec3 x = joint.square_axis2();
    return std::make_unique<SixCoordinates>(frames(joint.anchor, axes(x, joint.axis)), false);
  }
  std::unique_ptr<BulletJointRows> operator()(const CylindricalJoint& joint) const {
    return slider(joint.anchor, joint.axis, false);
  }
  std::unique_ptr<BulletJointRows> operator()(const DistanceJoint&) const { return nullptr; }
  // None of these is among the features.
  std::unique_ptr<BulletJointRows> operator()(const CompoundAxis&) const { return nullptr; }
  std::unique_ptr<BulletJointRows> operator()(const CompoundJoint&) const { return nullptr; }
  std::unique_ptr<BulletJointRows> operator()(const PlanarJoint&) const { return nullptr; }
  std::unique_ptr<BulletJointRows> operator()(const ScrewJoint&) const { return nullptr; }
  std::unique_ptr<BulletJointRows> slider(const Vec3& point, const Vec3& axis, bool keeps_turn) const {
    return std::make_unique<Slider>(frames(point, axes(axis, axis.cross(axis.unitOrthogonal()))), keeps_turn);
  }
};

}  // namespace

std::unique_ptr<BulletJointRows> make_bullet_rows(const Scene& scene, const Joint& joint) {
  const MakeRows make{end_at_start(scene, joint.a), end_at_start(scene, joint.b), scene.pose(joint.b).position};
  return std::visit(make, joint.type);
}

}  // namespace rigor::inline adapters
