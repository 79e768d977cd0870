// The features with which two bodies touch, for the method `event`: a point, a line or a plane of each, with a radius
// around it. The features are constant as long as a contact lasts. Its gap, normal and place are therefore smooth
// functions of the poses, with rates of change in closed form:
//   a corner, the centre of a ball or of a capsule's end   a point
//   an edge, a capsule's axis                              a line
//   a side of a box, a plane                               a plane
// A line and a side end. A ball that rolls over the edge of a box, or past the end of a capsule, passes from one
// feature to the next. Its normal is continuous there, and its acceleration jumps.
#pragma once

#include <cstdint>
#include <optional>

#include "core/dynamics/collision/colliders.h"

namespace rigor {

struct ContactFeature {
  enum class Kind : std::uint8_t { point, line, plane } kind = Kind::point;
  Vec3 at = Vec3::Zero();         // m, in B: the point, or one of the line or the plane
  Vec3 direction = Vec3::Zero();  // unit, in B: along the line, or the plane's outward normal
  double radius = 0;              // m
  bool is_vertex = false;         // the centre of a ball or of a capsule's end, or a corner
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

struct ContactKinematics {
  Vec3 normal = Vec3::UnitX(), point = Vec3::Zero();  // unit, from b to a; m, midway between the surfaces; in W
  double gap = 0;                                     // m
  Vec3 normal_rate = Vec3::Zero(), point_rate = Vec3::Zero();  // 1/s, m/s
};

// The features at a point of a manifold, where the bodies touch.
FeaturePair features_at(const ManifoldPoint& point, const Collider& a, const Pose& pose_a, const Collider& b,
                        const Pose& pose_b);
ContactKinematics contact_kinematics(const FeaturePair& features, const RigidMotion& a, const RigidMotion& b);

// m: how far the contact can move before it passes to another feature of a body; negative beyond that, infinite if the
// features do not end. Features chosen at their end are within kAtEnd of the body's size.
double distance_from_ends(const FeaturePair& features, const ContactKinematics& kinematics, const Collider& a,
                          const Pose& pose_a, const Collider& b, const Pose& pose_b);
constexpr double kAtEnd = 1e-11;

}  // namespace rigor
