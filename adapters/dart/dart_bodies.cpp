#include "adapters/dart/dart_bodies.h"

#include <fmt/format.h>

#include <dart/dynamics/BallJoint.hpp>
#include <dart/dynamics/FreeJoint.hpp>
#include <dart/dynamics/PrismaticJoint.hpp>
#include <dart/dynamics/RevoluteJoint.hpp>
#include <dart/dynamics/UniversalJoint.hpp>
#include <dart/dynamics/WeldJoint.hpp>

namespace rigor::inline adapters {
namespace {

namespace dyn = ::dart::dynamics;

// The joint's frame is at its anchor, or at the centre of what hangs on it.
Vec3 point_of(const Joint& joint, const Body& hanging) {
  const Vec3* anchor = anchor_of(joint);
  return anchor ? *anchor : hanging.position;
}

class SkeletonMaker {
 public:
  SkeletonMaker(const Scene& scene, const SpanningTree& tree) : scene_(scene), tree_(tree) {
    made_.bodies.assign(scene.bodies.size(), nullptr);
    made_.coordinates.resize(scene.joints.size());
  }

  DartBodies make() {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      if (!scene_.bodies[i].fixed) continue;
      begin(fmt::format("fixed{}", i))->setMobile(false);
      add<dyn::WeldJoint>(static_cast<int>(i), nullptr)
          ->setTransformFromParentBodyNode(dart_transform(scene_.bodies[i].position, scene_.bodies[i].orientation));
    }
    for (const int root : tree_.roots) {
      begin(fmt::format("tree{}", root));
      waiting_ = {root};
      while (!waiting_.empty()) hang_next();
    }
    return std::move(made_);
  }

 private:
  dyn::SkeletonPtr begin(const std::string& name) {
    made_.skeletons.push_back(dyn::Skeleton::create(name));
    return made_.skeletons.back();
  }

  void hang_next() {
    const int body = waiting_.back();
    waiting_.pop_back();
    tree_.links[body].joint < 0 ? float_free(body) : hang(body);
    waiting_.insert(waiting_.end(), tree_.below[body].begin(), tree_.below[body].end());
  }

  template <typename JointType>
  JointType* add(int index, dyn::BodyNode* parent) {
    const Body& body = scene_.bodies[index];
    const auto [joint, node] = made_.skeletons.back()->createJointAndBodyNodePair<JointType>(parent);
    joint->setName(fmt::format("j{}", index)), node->setName(fmt::format("b{}", index));
    if (!body.fixed) node->setInertia(dyn::Inertia(body.mass, Vec3::Zero(), body.inertia));  // any symmetric matrix
    made_.bodies[index] = node;
    return joint;
  }

  void float_free(int index) {
    const Body& body = scene_.bodies[index];
    auto* joint = add<dyn::FreeJoint>(index, nullptr);
    dyn::FreeJoint::setTransformOf(joint, dart_transform(body.position, body.orientation));
    joint->setLinearVelocity(body.velocity), joint->setAngularVelocity(body.angular_velocity);  // in W, of the centre
  }

  void hang(int index) {
    const SpanningTree::Link& link = tree_.links[index];
    const Joint& joint = scene_.joints[link.joint];
    dyn::BodyNode* parent = link.parent == kWorld ? nullptr : made_.bodies[link.parent];
    dyn::Joint* made = make_joint(joint, index, parent);
    const Body& body = scene_.bodies[index];
    const BodyPose above = scene_.pose(link.parent);
    const Eigen::Isometry3d frame = dart_transform(point_of(joint, body), body.orientation);
    made->setTransformFromParentBodyNode(dart_transform(above.position, above.orientation).inverse() * frame);
    made->setTransformFromChildBodyNode(dart_transform(body.position, body.orientation).inverse() * frame);
    const std::vector<double> speeds = hanging_speeds(scene_, tree_, index);
    for (std::size_t k = 0; k < speeds.size(); ++k) made->setVelocity(k, speeds[k]);
    if (!free_axis(joint)) return;
    made_.coordinates[link.joint] = {made, joint.b == index ? 1.0 : -1.0};
    drive(made_.coordinates[link.joint], joint);
  }

  dyn::Joint* make_joint(const Joint& joint, int index, dyn::BodyNode* parent) {
    const Mat3 to_body = matrix_of(scene_.bodies[index].orientation).transpose();
    const auto along = [&](auto* made, const Vec3& axis) -> dyn::Joint* {
      made->setAxis(to_body * axis);
      return made;
    };
    return std::visit(
        ForJoints{
            [&](const BallJoint&) -> dyn::Joint* { return add<dyn::BallJoint>(index, parent); },
            [](const CylindricalJoint&) -> dyn::Joint* { return nullptr; },  // not among the features
            [](const DistanceJoint&) -> dyn::Joint* { return nullptr; },
            [&](const FixedJoint&) -> dyn::Joint* { return add<dyn::WeldJoint>(index, parent); },
            [&](const HingeJoint& hinge) { return along(add<dyn::RevoluteJoint>(index, parent), hinge.axis); },
            [&](const SliderJoint& slider) { return along(add<dyn::PrismaticJoint>(index, parent), slider.axis); },
            [&](const UniversalJoint& universal) -> dyn::Joint* {
              const Vec3 axis2 = universal.square_axis2();
              auto* made = add<dyn::UniversalJoint>(index, parent);  // its first axis is fixed in the parent
              const bool is_b = joint.b == index;
              made->setAxis1(to_body * (is_b ? universal.axis : axis2));
              made->setAxis2(to_body * (is_b ? axis2 : universal.axis));
              return made;
            },
            LackingJoints<dyn::Joint*, CompoundAxis, CompoundJoint, PlanarJoint, ScrewJoint>()},
        joint.type);
  }

  static void drive(const DartBodies::Coordinate& at, const Joint& joint) {
    at.joint->setRestPosition(0, at.sign * joint.rest);  // before the limits, which it may be beyond
    at.joint->setSpringStiffness(0, joint.quadratic_stiffness > 0 ? 0 : joint.stiffness);  // else a load
    at.joint->setDampingCoefficient(0, joint.damping);
    if (!joint.has_limits()) return;
    at.joint->setPositionLowerLimit(0, at.sign > 0 ? joint.lower : -joint.upper);
    at.joint->setPositionUpperLimit(0, at.sign > 0 ? joint.upper : -joint.lower);
    at.joint->setLimitEnforcement(true);
  }

  const Scene& scene_;
  const SpanningTree& tree_;
  DartBodies made_;
  std::vector<int> waiting_;
};

}  // namespace

Eigen::Isometry3d dart_transform(const Vec3& position, const Quat& orientation) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.linear() = matrix_of(orientation);
  transform.translation() = position;
  return transform;
}

DartBodies dart_bodies(const Scene& scene, const SpanningTree& tree) { return SkeletonMaker(scene, tree).make(); }

}  // namespace rigor::inline adapters
