#include "core/dynamics/joints/joint_constraint.h"

namespace rigor {
namespace {

EndMotion at_start(const Scene& scene, int body) {
  const BodyPose pose = scene.pose(body);
  EndMotion end;
  end.position = pose.position, end.R = matrix_of(pose.orientation);
  return end;
}

struct Make {
  EndsAtStart ends;
  std::unique_ptr<JointConstraint> operator()(const BallJoint& joint) const { return make_ball(joint, ends); }
  std::unique_ptr<JointConstraint> operator()(const DistanceJoint& joint) const { return make_distance(joint, ends); }
  std::unique_ptr<JointConstraint> operator()(const FixedJoint& joint) const { return make_fixed(joint, ends); }
  std::unique_ptr<JointConstraint> operator()(const HingeJoint& joint) const { return make_hinge(joint, ends); }
  std::unique_ptr<JointConstraint> operator()(const SliderJoint& joint) const { return make_slider(joint, ends); }
  std::unique_ptr<JointConstraint> operator()(const UniversalJoint& joint) const { return make_universal(joint, ends); }
};

}  // namespace

std::unique_ptr<JointConstraint> make_constraint(const Scene& scene, const Joint& joint) {
  return std::visit(Make{{at_start(scene, joint.a), at_start(scene, joint.b)}}, joint.type);
}

}  // namespace rigor
