// When two bodies that nothing touches meet.
#pragma once

#include "core/dynamics/collision/colliders.h"

namespace rigor::inline dynamics {

// Of a body that nothing touches.
struct FreeMotion {
  Pose pose;
  Vec3 v, w;  // m/s, rad/s in W

  Vec3 velocity_at(const Vec3& point) const { return v + w.cross(point - pose.p); }
  void advance(double t);
  FreeMotion after(double t) const;
};
FreeMotion free_motion_of(BodyColumns state, const Collider& collider, const Pose& pose);

// m/s, at which the gap of a point closes.
double approach(const ManifoldPoint& point, const FreeMotion& a, const FreeMotion& b);
// s, the first time at which one of these points closes its gap; 0 if one is closed, or if none does within dt.
double time_of_impact(const Manifold& points, const FreeMotion& a, const FreeMotion& b, double dt);
// The same for a body that rotates so far that its surface leaves the path of its present velocity: in steps that no
// point can outrun (conservative advancement). `turning`: m/s, of the fastest points; `margin`: m, a gap that counts as
// zero.
double time_of_turning_impact(const Collider& a, const Collider& b, const FreeMotion& motion_a,
                              const FreeMotion& motion_b, double turning, double margin, double dt);

}  // namespace rigor::inline dynamics
