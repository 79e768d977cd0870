// The ends of a joint in ODE's order, for the engine and its twin. An angle or displacement is that of ODE's first body
// relative to its second, and the first must move. So b comes first, which gives the scene's signs. If b is fixed, a
// comes first and all signs change.
#pragma once

#include "core/scene/scene.h"

namespace rigor::inline adapters {

template <typename T>
struct OdePair {
  T first, second;
};

class OdeJointEnds {
 public:
  OdeJointEnds(const Scene& scene, const Joint& joint) : scene_(scene), joint_(joint) {
    const auto moves = [&](int body) { return body != kWorld && !scene.bodies[static_cast<std::size_t>(body)].fixed; };
    b_is_first_ = moves(joint.b);
    bodies = b_is_first_ ? OdePair<int>{joint.b, moves(joint.a) ? joint.a : kWorld} : OdePair<int>{joint.a, kWorld};
  }

  OdePair<int> bodies;                                  // indices; the second kWorld where it stays
  double sign() const { return b_is_first_ ? 1 : -1; }  // of ODE's angle or displacement, against the scene's

  // In W at t = 0.
  OdePair<Vec3> points(const DistanceJoint& distance) const {
    return ordered(in_W(joint_.a, distance.point_a), in_W(joint_.b, distance.point_b));
  }
  // In W at t = 0, at right angles to the last digit.
  OdePair<Vec3> axes(const UniversalJoint& universal) const {
    return ordered(universal.axis, universal.square_axis2());
  }

 private:
  OdePair<Vec3> ordered(const Vec3& of_a, const Vec3& of_b) const {
    return b_is_first_ ? OdePair<Vec3>{of_b, of_a} : OdePair<Vec3>{of_a, of_b};
  }
  Vec3 in_W(int body, const Vec3& point) const {
    const BodyPose pose = scene_.pose(body);
    return pose.position + pose.orientation * point;
  }

  const Scene& scene_;
  const Joint& joint_;
  bool b_is_first_;
};

}  // namespace rigor::inline adapters
