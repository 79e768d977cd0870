#include "adapters/common/spanning_tree.h"

#include <algorithm>
#include <numeric>

#include "core/scene/joints/axis_series.h"

namespace rigor::inline adapters {
namespace {

// Bodies that hang together, and the world, as sets that are joined.
class Clusters {
 public:
  explicit Clusters(const Scene& scene) : of_(scene.bodies.size() + 1) {
    std::iota(of_.begin(), of_.end(), 0);
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
      if (scene.bodies[i].fixed) of_[i + 1] = 0;
    }
  }
  bool join(int a, int b) {  // false if they were one already
    const int first = find(a + 1), second = find(b + 1);
    of_[std::max(first, second)] = std::min(first, second);
    return first != second;
  }

 private:
  int find(int i) {
    while (of_[i] != i) i = of_[i] = of_[of_[i]];
    return i;
  }
  std::vector<int> of_;
};

// The least is taken first. A distance joint is never part of the tree.
int rank_of(const Joint& joint) {
  return std::visit(ForJoints{[](const SliderJoint&) { return 0; }, [](const CylindricalJoint&) { return 1; },
                              [](const CompoundAxis&) { return 1; }, [](const CompoundJoint&) { return 1; },
                              [](const PlanarJoint&) { return 1; }, [](const ScrewJoint&) { return 1; },
                              [](const UniversalJoint&) { return 2; }, [](const HingeJoint&) { return 3; },
                              [](const FixedJoint&) { return 4; }, [](const BallJoint&) { return 5; },
                              [](const DistanceJoint&) { return 6; }},
                    joint.type);
}

bool moves(const Scene& scene, int body) { return body != kWorld && !scene.bodies[body].fixed; }

// The joints of the forest, by body at either end.
struct Neighbour {
  int body, joint;
};
using Neighbours = std::vector<std::vector<Neighbour>>;  // by body + 1; the world is first

Neighbours span(const Scene& scene, std::vector<int>& loops) {
  std::vector<int> joints(scene.joints.size());
  std::iota(joints.begin(), joints.end(), 0);
  std::stable_sort(joints.begin(), joints.end(),
                   [&](int a, int b) { return rank_of(scene.joints[a]) < rank_of(scene.joints[b]); });
  Clusters clusters(scene);
  Neighbours neighbours(scene.bodies.size() + 1);
  for (const int k : joints) {
    const Joint& joint = scene.joints[k];
    if (is_axis_of_compound(joint)) continue;
    const int a = moves(scene, joint.a) ? joint.a : kWorld, b = moves(scene, joint.b) ? joint.b : kWorld;
    if (std::holds_alternative<DistanceJoint>(joint.type) || !clusters.join(a, b)) {
      loops.push_back(k);
      continue;
    }
    neighbours[a + 1].push_back({b, k});
    neighbours[b + 1].push_back({a, k});
  }
  return neighbours;
}

}  // namespace

SpanningTree spanning_tree(const Scene& scene) {
  SpanningTree tree;
  const Neighbours neighbours = span(scene, tree.loops);
  tree.links.resize(scene.bodies.size());
  tree.below.resize(scene.bodies.size());
  std::vector<bool> reached(scene.bodies.size(), false);
  std::vector<int> waiting;
  const auto hang = [&](int parent) {
    for (const auto& [body, joint] : neighbours[parent + 1]) {
      if (body == kWorld || reached[body]) continue;
      tree.links[body] = {parent, joint};
      (parent == kWorld ? tree.roots : tree.below[parent]).push_back(body);
      reached[body] = true, waiting.push_back(body);
    }
  };
  const auto hang_all = [&] {
    while (!waiting.empty()) {
      const int body = waiting.back();
      waiting.pop_back();
      hang(body);
    }
  };
  hang(kWorld);
  hang_all();
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    if (scene.bodies[i].fixed || reached[i]) continue;
    tree.roots.push_back(i), waiting.push_back(i), reached[i] = true;
    hang_all();
  }
  return tree;
}

namespace {

struct StartingMotion {  // in W
  Vec3 position = Vec3::Zero(), velocity = Vec3::Zero(), turning = Vec3::Zero();
};

StartingMotion starting_motion(const Scene& scene, int body) {
  if (!moves(scene, body)) return {};
  const Body& b = scene.bodies[body];
  return {b.position, b.velocity, b.angular_velocity};
}

// A universal joint's two speeds: those whose rotation is nearest to w, which is w without its part along the normal.
std::vector<double> speeds_about(const Vec3& first, const Vec3& second, const Vec3& w) {
  const Vec3 normal = first.cross(second);
  const double squared = normal.squaredNorm();
  return {w.cross(second).dot(normal) / squared, first.cross(w).dot(normal) / squared};
}

// From the parent outwards; of a body that hangs as a, they count the other way.
std::vector<double> speeds_in_series(const Scene& scene, const Joint& joint, const CompoundJoint& compound,
                                     bool hangs_as_b) {
  const auto end = [&](int body) {
    const StartingMotion motion = starting_motion(scene, body);
    const BodyPose pose = scene.pose(body);
    return SeriesEnd{pose.position, motion.velocity, motion.turning, matrix_of(pose.orientation)};
  };
  const AxisSeries::Rows rows =
      AxisSeries(compound.axes, scene.pose(joint.a), scene.pose(joint.b)).at(end(joint.a), end(joint.b));
  std::vector<double> speeds;
  for (std::size_t i = 0; i < compound.axes.size(); ++i)
    speeds.push_back(hangs_as_b ? rows.coordinates[i].rate : -rows.coordinates[i].rate);
  if (!hangs_as_b) std::reverse(speeds.begin(), speeds.end());
  return speeds;
}

}  // namespace

std::vector<double> hanging_speeds(const Scene& scene, const SpanningTree& tree, int body) {
  const SpanningTree::Link& link = tree.links[body];
  const Joint& joint = scene.joints[link.joint];
  const StartingMotion own = starting_motion(scene, body), above = starting_motion(scene, link.parent);
  const Vec3 w = own.turning - above.turning;
  using Speeds = std::vector<double>;
  const auto speed_along = [&](const Vec3& axis, const Vec3& point) {
    const Vec3 carried = above.velocity + above.turning.cross(point - above.position);
    return axis.dot(own.velocity + own.turning.cross(point - own.position) - carried);
  };
  return std::visit(
      ForJoints{
          [&](const BallJoint&) -> Speeds {
            const Vec3 in_body = matrix_of(scene.bodies[body].orientation).transpose() * w;
            return {in_body.x(), in_body.y(), in_body.z()};
          },
          [&](const CylindricalJoint& cylinder) -> Speeds {
            return {speed_along(cylinder.axis, cylinder.anchor), cylinder.axis.dot(w)};
          },
          [&](const CompoundJoint& compound) { return speeds_in_series(scene, joint, compound, joint.b == body); },
          [](const CompoundAxis&) -> Speeds { return {}; }, [](const DistanceJoint&) -> Speeds { return {}; },
          [](const FixedJoint&) -> Speeds { return {}; },
          [&](const PlanarJoint& planar) -> Speeds {
            const PlaneDirections plane(planar.normal);
            return {speed_along(plane.first, planar.anchor), speed_along(plane.second, planar.anchor),
                    planar.normal.dot(w)};
          },
          [&](const ScrewJoint& screw) -> Speeds {
            return {speed_along(screw.axis, screw.anchor), screw.axis.dot(w)};
          },
          [&](const HingeJoint& hinge) -> Speeds { return {hinge.axis.dot(w)}; },
          [&](const SliderJoint& slider) -> Speeds { return {speed_along(slider.axis, own.position)}; },
          [&](const UniversalJoint& universal) -> Speeds {
            return joint.b == body ? speeds_about(universal.axis, universal.axis2, w)
                                   : speeds_about(universal.axis2, universal.axis, w);
          }},
      joint.type);
}

}  // namespace rigor::inline adapters
