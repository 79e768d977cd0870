// One body that swings or rotates about a fixed axis. On a hinge the axis may have any direction, and the body any
// inertia. On a ball joint, or a distance joint to its centre of mass, the motion must stay in a plane. r is the vector
// from the axis to the centre of mass across the axis, x the angle from its lowest position, and n the axis,
//   (n . I n + m r² + armature) x'' = -m g_n r sin x,   g_n the part of gravity across the axis
// (Landau and Lifshitz, Mechanics, 3rd ed., section 11, problem 1; Goldstein, Classical Mechanics, 3rd ed.,
// section 5.6, for the axis through the centre of mass, where it turns evenly). How x goes: pendulum_phase.h.
#include <fmt/format.h>

#include <algorithm>

#include "cases/truth/closed_form/joint/swinging_body.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

[[noreturn]] void refuse_pendulum(const std::string& why) {
  throw InputError("the truth 'pendulum' is for one body that turns about an axis that stands still: " + why);
}

constexpr Extended kPendulumRoundings = 64 * static_cast<Extended>(kEpsilon);  // of the scene's numbers, relative

struct Hung {
  int body;
  const Joint* joint;
  bool is_a;  // the body is the joint's a
};

Hung find_hung(const Scene& scene) {
  if (scene.joints.size() != 1) refuse_pendulum(fmt::format("there are {} joints", scene.joints.size()));
  const Joint& joint = scene.joints[0];
  if (stands(scene, joint.a) == stands(scene, joint.b))
    refuse_pendulum("the joint is not between it and what stands still");
  const bool is_a = !stands(scene, joint.a);
  const auto moving = std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return !b.fixed; });
  if (moving != 1) refuse_pendulum(fmt::format("{} bodies move", moving));
  return {is_a ? joint.a : joint.b, &joint, is_a};
}

// The normal of the plane of motion, spanned by gravity and the arm, or by the arm and the velocity.
ExtendedVec3 normal_of(const ExtendedVec3& arm, const ExtendedVec3& gravity, const ExtendedVec3& moving) {
  if (moving.norm() > 0) return moving.normalized();
  const ExtendedVec3 across = arm.cross(gravity);
  if (across.norm() <= kPendulumRoundings * arm.norm() * gravity.norm()) refuse_pendulum("it hangs still, or stands");
  return across.normalized();
}

void check_plane(const ExtendedVec3& normal, const ExtendedVec3& arm, const ExtendedVec3& gravity) {
  if (std::abs(normal.dot(arm)) > kPendulumRoundings * arm.norm()) refuse_pendulum("it swings round a cone");
  if (arm.norm() * std::abs(normal.dot(gravity)) > kPendulumRoundings * arm.norm() * gravity.norm())
    refuse_pendulum("gravity pulls it out of the plane in which it moves");
}

std::unique_ptr<Truth> on_ball(const Scene& scene, const Hung& hung, const Vec3& anchor) {
  const Body& body = scene.bodies[hung.body];
  const ExtendedVec3 arm = extended(body.position) - extended(anchor), g = extended(scene.gravity);
  const ExtendedVec3 normal = normal_of(arm, g, extended(body.angular_velocity));
  check_plane(normal, arm, g);
  const ExtendedVec3 n = extended(body.orientation).conjugate() * normal;
  const ExtendedMat3 inertia = extended(body.inertia);
  if (n.cross(inertia * n).norm() > kPendulumRoundings * inertia.norm())
    refuse_pendulum("on a ball joint it would leave the plane: the normal is no principal axis");
  return swinging(scene, normal, {round_axis(hung.body, normal, arm, true)}, false, refuse_pendulum);
}

std::unique_ptr<Truth> on_distance(const Scene& scene, const Hung& hung, const DistanceJoint& joint) {
  const Vec3& hook = hung.is_a ? joint.point_a : joint.point_b;
  if (!hook.isZero(0))
    refuse_pendulum(fmt::format("the distance joint holds it at ({}, {}, {})", hook.x(), hook.y(), hook.z()));
  const ExtendedVec3 pivot = hung.is_a ? standing_point(scene, hung.joint->b, joint.point_b)
                                       : standing_point(scene, hung.joint->a, joint.point_a);
  const Body& body = scene.bodies[hung.body];
  const ExtendedVec3 arm = extended(body.position) - pivot, g = extended(scene.gravity);
  const ExtendedVec3 normal = normal_of(arm, g, arm.cross(extended(body.velocity)));
  check_plane(normal, arm, g);
  return swinging(scene, normal, {round_axis(hung.body, normal, arm, false)}, true, refuse_pendulum);
}

std::unique_ptr<Truth> make_pendulum(const Scene& scene, double) {
  check_needs(
      scene, "pendulum", "one body on one joint",
      {joint_feature<BallJoint>(), joint_feature<DistanceJoint>(), joint_feature<HingeJoint>(), Feature::armature});
  const Hung hung = find_hung(scene);
  if (const auto* ball = std::get_if<BallJoint>(&hung.joint->type)) return on_ball(scene, hung, ball->anchor);
  if (const auto* distance = std::get_if<DistanceJoint>(&hung.joint->type)) return on_distance(scene, hung, *distance);
  const auto& hinge = std::get<HingeJoint>(hung.joint->type);
  const ExtendedVec3 axis = extended(hinge.axis).normalized(),
                     arm = extended(scene.bodies[hung.body].position) - extended(hinge.anchor);
  return swinging(scene, axis, {round_axis(hung.body, axis, arm, true)}, false, refuse_pendulum,
                  Extended(hung.joint->armature));
}

}  // namespace

TruthRow pendulum_truth() {
  return {"pendulum", "a body on a hinge, or in a plane on a ball or distance joint, in elliptic functions",
          make_pendulum};
}

}  // namespace rigor::inline truth
