// The rows of Bullet 3.24's constraints, as bullet_joints.h chooses them, on the matched track. Some rows are written
// differently from the core's. This matters: the same joint has other numbers, to second order in the gap.
#pragma once

#include <memory>
#include <vector>

#include "core/dynamics/joints/constraint_rows.h"
#include "core/scene/scene.h"

namespace rigor::inline adapters {

// Where an end of a joint is; the world at W itself.
struct BulletEnd {
  Vec3 position = Vec3::Zero();  // m
  Mat3 R = Mat3::Identity();     // to W
  double inverse_mass = 0;       // 1/kg, 0 of what stays
};

class BulletJointRows {
 public:
  virtual ~BulletJointRows() = default;
  // Their `bias` means nothing: Bullet works with velocities.
  virtual void add_to(std::vector<ConstraintRow>& rows, const BulletEnd& a, const BulletEnd& b) const = 0;
};

// Null for a joint that Bullet does not have. A fixed body counts as the world.
std::unique_ptr<BulletJointRows> make_bullet_rows(const Scene& scene, const Joint& joint);

}  // namespace rigor::inline adapters
