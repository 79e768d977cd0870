#include "adapters/simbody/simbody_mobilizers.h"

#include "adapters/common/spanning_tree.h"

namespace rigor::inline adapters {
namespace {

Mobilizer mobilizer_of(const Scene& scene, int body, const SpanningTree::Link& link) {
  if (link.joint < 0) return {MobilizerKind::free, body, kWorld, Mat3::Identity(), Vec3::Zero()};
  const Joint& joint = scene.joints[link.joint];
  const Mat3 straight = Mat3::Identity();
  const Vec3& centre = scene.bodies[body].position;
  const auto made = [&](MobilizerKind kind, const Mat3& axes, const Vec3& origin) {
    return Mobilizer{kind, body, link.parent, axes, origin};
  };
  return std::visit(
      ForJoints{
          [&](const BallJoint& ball) { return made(MobilizerKind::ball, straight, ball.anchor); },
          // Not among the features.
          [&](const CompoundAxis&) { return made(MobilizerKind::free, straight, centre); },
          [&](const CompoundJoint&) { return made(MobilizerKind::free, straight, centre); },
          [&](const PlanarJoint&) { return made(MobilizerKind::free, straight, centre); },
          [&](const ScrewJoint&) { return made(MobilizerKind::free, straight, centre); },
          [&](const CylindricalJoint& cylinder) {
            return made(MobilizerKind::cylinder, axes_with(2, cylinder.axis), cylinder.anchor);
          },
          // A distance joint always closes a loop, and hangs nothing.
          [&](const DistanceJoint&) { return made(MobilizerKind::free, straight, centre); },
          [&](const FixedJoint&) { return made(MobilizerKind::weld, straight, centre); },
          [&](const HingeJoint& hinge) { return made(MobilizerKind::pin, axes_with(2, hinge.axis), hinge.anchor); },
          [&](const SliderJoint& slider) { return made(MobilizerKind::slider, axes_with(0, slider.axis), centre); },
          [&](const UniversalJoint& universal) {
            const bool hangs_as_b = joint.b == body;  // x is fixed in the parent, y in what hangs on it
            const Vec3 x = hangs_as_b ? universal.axis : universal.axis2,
                       y = hangs_as_b ? universal.axis2 : universal.axis;
            Mat3 axes;
            axes.col(0) = x, axes.col(1) = (y - y.dot(x) * x).normalized(), axes.col(2) = x.cross(axes.col(1));
            return made(MobilizerKind::universal, axes, universal.anchor);
          }},
      joint.type);
}

}  // namespace

Mat3 axes_with(int which, const Vec3& direction) {
  Mat3 axes;
  axes.col(which) = direction;
  axes.col((which + 1) % 3) = direction.unitOrthogonal();
  axes.col((which + 2) % 3) = direction.cross(axes.col((which + 1) % 3));
  return axes;
}

std::vector<Mobilizer> mobilizers_of(const Scene& scene) {
  const SpanningTree tree = spanning_tree(scene);
  std::vector<Mobilizer> mobilizers;
  std::vector<int> waiting = tree.roots;
  while (!waiting.empty()) {
    const int body = waiting.back();
    waiting.pop_back();
    mobilizers.push_back(mobilizer_of(scene, body, tree.links[body]));
    waiting.insert(waiting.end(), tree.below[body].begin(), tree.below[body].end());
  }
  return mobilizers;
}

}  // namespace rigor::inline adapters
