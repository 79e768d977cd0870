// The features with which two bodies touch, for the method `event`: a point, a line or a plane of each, with a radius
// around it. The features are constant as long as a contact lasts. Its gap, normal and place are therefore smooth
// functions of the poses, with rates of change in closed form:
//   a corner, the centre of a ball or of a capsule's end   a point
//   an edge, a capsule's axis                              a line
//   a side of a box, a plane, a triangle                   a plane
//   an ellipsoid, the rim of a cylinder                    a round surface, whose point follows from its normal
//   the end of a cylinder that lies flat                   points of its rim
// A line and a side end. A ball that rolls over the edge of a box, or past the end of a capsule, passes from one
// feature to the next. Its normal is continuous there, and its acceleration jumps.
#pragma once

#include <cstdint>
#include <optional>

#include "core/dynamics/collision/colliders.h"

namespace rigor::inline dynamics {

struct ContactFeature {
  enum class Kind : std::uint8_t { point, line, plane, round } kind = Kind::point;
  Vec3 at = Vec3::Zero();  // m, in B: the point, one of the line or the plane, or the round surface's centre
  // Unit, in B: along the line, or the plane's outward normal. Of a rim: in W, from its centre to the contact, when
  // that began.
  Vec3 direction = Vec3::Zero();
  double radius = 0;              // m
  bool is_vertex = false;         // the centre of a ball or of a capsule's end, or a corner
  int place = -1;                 // on a surface of triangles: which triangle, ridge or peak this is
  Mat3 half_axes = Mat3::Zero();  // m, in B: of a round surface (round_surface.h)
};

struct FeaturePair {
  ContactFeature a, b;
  double side = 1;  // of two lines: the normal is side ea x eb
};

// How a body moves: its pose and its velocities, in W.
struct RigidMotion {
  Pose pose;
  Vec3 v = Vec3::Zero(), w = Vec3::Zero();
};
// In the frame of the collider's body; a plane's feature is fixed in W.
RigidMotion motion_of(BodyColumns state, const Collider& collider);

// The features at a point of a manifold, where the bodies touch. Those chosen at their end are within kAtEnd of the
// body's size.
constexpr double kAtEnd = 1e-11;
FeaturePair features_at(const ManifoldPoint& point, const Collider& a, const Pose& pose_a, const Collider& b,
                        const Pose& pose_b);

}  // namespace rigor::inline dynamics
