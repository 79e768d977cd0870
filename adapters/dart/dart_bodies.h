// A scene's bodies and joints as DART's skeletons, one for each tree of joints.
//
// DART's conventions and ours: both use SI. A body's frame is ours, with its origin at the centre of mass; poses are
// transforms from the body to the world. A joint's frame is at its point, oriented like its child body, so a ball
// joint's rates are those of that body in its own frame. Angles and displacements count from t = 0.
#pragma once

#include <dart/dynamics/BodyNode.hpp>
#include <dart/dynamics/Skeleton.hpp>
#include <vector>

#include "adapters/common/spanning_tree.h"

namespace rigor::inline adapters {

struct DartBodies {
  std::vector<::dart::dynamics::SkeletonPtr> skeletons;
  std::vector<::dart::dynamics::BodyNode*> bodies;  // by body of the scene; one that is fixed does not move
  // One per joint of the scene: null if it has no coordinate of its own. DART counts from parent to child: our
  // coordinate is equal or the negative.
  struct Coordinate {
    ::dart::dynamics::Joint* joint = nullptr;
    double sign = 1;
  };
  std::vector<Coordinate> coordinates;
};

// With the velocities of t = 0, and with springs, dampers and limits of the joints that hang bodies.
DartBodies dart_bodies(const Scene& scene, const SpanningTree& tree);

Eigen::Isometry3d dart_transform(const Vec3& position, const Quat& orientation);

}  // namespace rigor::inline adapters
