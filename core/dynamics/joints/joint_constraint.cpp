#include "core/dynamics/joints/joint_constraint.h"

namespace rigor::inline dynamics {
namespace {

EndMotion at_start(const Scene& scene, int body) {
  const BodyPose pose = scene.pose(body);
  EndMotion end;
  end.position = pose.position, end.R = matrix_of(pose.orientation);
  return end;
}

struct Make {
  const Scene& scene;
  const Joint& joint;
  EndsAtStart ends;
  std::unique_ptr<JointConstraint> operator()(const CompoundAxis&) const { return make_axis_of_series(); }
  std::unique_ptr<JointConstraint> operator()(const CompoundJoint& type) const {
    return make_series(type, scene.pose(joint.a), scene.pose(joint.b));
  }
  std::unique_ptr<JointConstraint> operator()(const ScrewJoint& type) const { return make_screw(type, ends); }
  std::unique_ptr<JointConstraint> operator()(const DistanceJoint& type) const { return make_distance(type, ends); }
  std::unique_ptr<JointConstraint> operator()(const UniversalJoint& type) const { return make_universal(type, ends); }
  template <typename Type>
  std::unique_ptr<JointConstraint> operator()(const Type&) const {
    constexpr unsigned mask = Type::descriptor().locks.value();
    return make_masked(mask, anchor_of(joint), axis_of(joint), ends);
  }
};

}  // namespace

std::unique_ptr<JointConstraint> make_constraint(const Scene& scene, const Joint& joint) {
  return std::visit(Make{scene, joint, {at_start(scene, joint.a), at_start(scene, joint.b)}}, joint.type);
}

}  // namespace rigor::inline dynamics
