// Conversion between Rigor's conventions and Bullet's. Both use SI units, right-handed frames, and velocities of the
// centre of mass in the world frame. They differ in the quaternion's order (ours w first, Bullet's last), and in the
// inertia. Ours is any symmetric matrix in the body frame B, Bullet's is diagonal. Bullet therefore gets the principal
// frame P, rotated relative to B by a constant R_BP.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline adapters::bullet {

inline btVector3 to_bullet(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
inline Vec3 to_rigor(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

inline btMatrix3x3 to_bullet(const Mat3& m) {
  return {m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)};
}
inline Mat3 to_rigor(const btMatrix3x3& m) {
  Mat3 out;
  for (int row = 0; row < 3; ++row) out.row(row) = to_rigor(m[row]);
  return out;
}
inline btQuaternion to_bullet(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }
inline Quat to_rigor(const btQuaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }

struct PrincipalFrame {
  Vec3 moments = Vec3::Ones();   // kg m², about P's axes
  Mat3 R_BP = Mat3::Identity();  // P to B
  bool turned = false;           // whether P is not B
};

// A diagonal inertia keeps its own frame, so that nothing is turned without need.
PrincipalFrame principal_frame(const Mat3& inertia_B);

// Shapes live as long as the bodies that use them.
using Shapes = std::vector<std::unique_ptr<btCollisionShape>>;

// The shape, given in B, for a body whose own frame is P. A plane is given in the world frame, and its body stands
// there. `has_margins`: hulls keep the margin that Bullet ships.
btCollisionShape* add_shape(const Shape& shape, const PrincipalFrame& frame, bool has_margins, Shapes& shapes);

}  // namespace rigor::inline adapters::bullet
