#include "adapters/siconos/process/siconos_joints.h"

#include <EqualityConditionNSL.hpp>
#include <FixedJointR.hpp>
#include <KneeJointR.hpp>
#include <PivotJointR.hpp>
#include <PrismaticJointR.hpp>
#include <SiconosVector.hpp>
#include <stdexcept>

namespace rigor::inline adapters::siconos {
namespace {

SP::SiconosVector pose_at_start(const Scene& scene, int body) {
  const BodyPose pose = scene.pose(body);
  const auto q = std::make_shared<SiconosVector>(7);
  for (int k = 0; k < 3; ++k) (*q)(k) = pose.position[k];
  (*q)(3) = pose.orientation.w(), (*q)(4) = pose.orientation.x();
  (*q)(5) = pose.orientation.y(), (*q)(6) = pose.orientation.z();
  return q;
}

// Anchors and axes are in W at t = 0.
struct Relation {
  std::shared_ptr<NewtonEulerJointR> operator()(const BallJoint& ball) const {
    return placed(std::make_shared<KneeJointR>(), &ball.anchor, nullptr);
  }
  std::shared_ptr<NewtonEulerJointR> operator()(const HingeJoint& hinge) const {
    return placed(std::make_shared<PivotJointR>(), &hinge.anchor, &hinge.axis);
  }
  std::shared_ptr<NewtonEulerJointR> operator()(const SliderJoint& slider) const {
    return placed(std::make_shared<PrismaticJointR>(), nullptr, &slider.axis);
  }
  std::shared_ptr<NewtonEulerJointR> operator()(const FixedJoint&) const {
    return placed(std::make_shared<FixedJointR>(), nullptr, nullptr);
  }
  std::shared_ptr<NewtonEulerJointR> operator()(const CylindricalJoint&) const { return lacking(); }
  std::shared_ptr<NewtonEulerJointR> operator()(const DistanceJoint&) const { return lacking(); }
  std::shared_ptr<NewtonEulerJointR> operator()(const UniversalJoint&) const { return lacking(); }
  std::shared_ptr<NewtonEulerJointR> operator()(const CompoundAxis&) const { return lacking(); }
  std::shared_ptr<NewtonEulerJointR> operator()(const CompoundJoint&) const { return lacking(); }
  std::shared_ptr<NewtonEulerJointR> operator()(const PlanarJoint&) const { return lacking(); }
  std::shared_ptr<NewtonEulerJointR> operator()(const ScrewJoint&) const { return lacking(); }
  static std::shared_ptr<NewtonEulerJointR> lacking() {
    throw std::logic_error("a joint that is not among the features");
  }
  static std::shared_ptr<NewtonEulerJointR> placed(std::shared_ptr<NewtonEulerJointR> joint, const Vec3* point,
                                                   const Vec3* axis) {
    joint->setAbsolute(true);
    if (point) joint->setPoint(0, vector_of(*point));
    if (axis) joint->setAxis(0, vector_of(*axis));
    return joint;
  }
};

}  // namespace

void link_joints(const Scene& scene, const Bodies& bodies, NonSmoothDynamicalSystem& into) {
  const auto system_of = [&](int body) {
    return body == kWorld ? nullptr : bodies.systems()[static_cast<std::size_t>(body)];
  };
  for (const Joint& joint : scene.joints) {
    const bool starts_at_b = !system_of(joint.a);
    const int first = starts_at_b ? joint.b : joint.a, second = starts_at_b ? joint.a : joint.b;
    const auto relation = std::visit(Relation{}, joint.type);
    const BodyPointer one = system_of(first), other = system_of(second);
    if (!one) continue;  // between two that are fixed
    relation->setBasePositions(pose_at_start(scene, first), other ? pose_at_start(scene, second) : SP::SiconosVector());
    const auto law = std::make_shared<EqualityConditionNSL>(relation->numberOfConstraints());
    const auto interaction = std::make_shared<Interaction>(law, relation);
    other ? into.link(interaction, one, other) : into.link(interaction, one);
  }
}

}  // namespace rigor::inline adapters::siconos
