#include "adapters/simbody/simbody_mobilizers.h"

#include "adapters/spanning_tree.h"

namespace rigor {
namespace {

Mobilizer mobilizer_of(const Scene& scene, int body, const SpanningTree::Link& link) {
  if (link.joint < 0) return {MobilizerKind::free, body, kWorld, Mat3::Identity(), Vec3::Zero()};
  const Joint& joint = scene.joints[link.joint];
  const Mat3 straight = Mat3::Identity();
  if (const auto* ball = std::get_if<BallJoint>(&joint.type))
    return {MobilizerKind::ball, body, link.parent, straight, ball->anchor};
  if (const auto* hinge = std::get_if<HingeJoint>(&joint.type))
    return {MobilizerKind::pin, body, link.parent, axes_with(2, hinge->axis), hinge->anchor};
  if (const auto* slider = std::get_if<SliderJoint>(&joint.type))
    return {MobilizerKind::slider, body, link.parent, axes_with(0, slider->axis), scene.bodies[body].position};
  if (const auto* universal = std::get_if<UniversalJoint>(&joint.type)) {
    const bool hangs_as_b = joint.b == body;  // x is fixed in the parent, y in what hangs on it
    const Vec3 x = hangs_as_b ? universal->axis : universal->axis2, y = hangs_as_b ? universal->axis2 : universal->axis;
    Mat3 axes;
    axes.col(0) = x, axes.col(1) = (y - y.dot(x) * x).normalized(), axes.col(2) = x.cross(axes.col(1));
    return {MobilizerKind::universal, body, link.parent, axes, universal->anchor};
  }
  return {MobilizerKind::weld, body, link.parent, straight, scene.bodies[body].position};
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

}  // namespace rigor
