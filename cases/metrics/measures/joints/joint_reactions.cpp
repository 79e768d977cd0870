#include "cases/metrics/measures/joints/joint_reactions.h"

#include <algorithm>
#include <array>

#include "cases/metrics/measures/joints/joint_series.h"
#include "core/base/eigen_of.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {
namespace {

Vec3 centripetal(const MovingEnd& body, const Vec3& arm) { return body.w.cross(body.w.cross(arm)); }

// Two directions across an axis.
std::array<Vec3, 2> across(const Vec3& axis) {
  const Vec3 first = axis.unitOrthogonal();
  return {first, axis.cross(first).normalized()};
}

// The directions in which the loads of the null space do not act. None where the joint can carry nothing in them: of
// what is always zero there is nothing to compare.
Mat3 unique_directions(const Mat3& null_loads, const Mat3& can_carry) {
  const SymmetricEigen loads = eigen_of(null_loads);
  Mat3 unique = Mat3::Zero();
  constexpr double kNothing = 1e-14;  // 1e-7 of the largest load, squared: roundings are 1e-10, real shares per mille
  for (int k = 0; k < 3; ++k) {
    const Vec3 direction = loads.vectors.col(k);
    if (loads.values[k] <= kNothing) unique += direction * direction.transpose();
  }
  return (unique * can_carry).trace() > kNothing ? unique : Mat3(Mat3::Zero());
}

}  // namespace

std::string why_reactions_are_unknown(const Scene& scene) {
  if (scene.joints.empty()) return kNoJoints;
  if (anything_can_touch(scene)) return "bodies can touch, and what contacts carry then is not known";
  for (const Joint& joint : scene.joints) {
    if (joint.has_limits()) return "a joint has limits, and what they carry is not known";
    if (joint.armature > 0) return "a joint has an armature, and what its rotor gives is not computed";
    if (std::holds_alternative<CompoundJoint>(joint.type) || std::holds_alternative<PlanarJoint>(joint.type) ||
        std::holds_alternative<ScrewJoint>(joint.type))
      return "what compound joints, planar joints and screws carry is not computed";
  }
  if (!scene.couplings.empty()) return "joints are coupled, and what couplings carry is not computed";
  for (const Motor& motor : scene.motors) {
    if (motor.speed) return "a motor keeps a speed, and what it gives is not known";
    if (motor.servo && motor.servo->period > 0) return "a servo holds its effort between samples, which no state shows";
  }
  return "";
}

JointReactions::JointReactions(const Scene& scene) : scene_(scene), system_(scene) {
  for (const Joint& joint : scene.joints) joints_.emplace_back(scene, joint);
  int moving = 0;
  for (const Body& body : scene.bodies) order_.push_back(body.fixed ? -1 : moving++);
  inverse_mass_.resize(moving);
  // How many rows are in use is decided where the joints hold: at the start.
  BodyTable start(scene.bodies.size());
  set_initial_state(scene, start.columns());
  find_rows(start.columns());
}

void JointReactions::add_row(std::size_t joint, const MovingEnd& a, const MovingEnd& b, const Vec3& force,
                             const Vec3& couple, double bias) {
  Row row;
  const auto set = [&](int end, int body, double sign, const Vec3& arm) {
    if (body == kWorld || order_[body] < 0) return;
    row.body[end] = order_[body];
    row.block[end] << sign * force, sign * (arm.cross(force) + couple);
  };
  set(0, scene_.joints[joint].a, -1, joints_[joint].slides() ? Vec3(b.point() - a.centre) : a.arm);
  set(1, scene_.joints[joint].b, 1, b.arm);
  row.bias = bias;
  rows_.push_back(row);
  held_.push_back({joint, force, couple});
}

void JointReactions::add_point_row(std::size_t joint, const MovingEnd& a, const MovingEnd& b, const Vec3& direction) {
  add_row(joint, a, b, direction, Vec3::Zero(), direction.dot(centripetal(b, b.arm) - centripetal(a, a.arm)));
}

// u . v stays as it is, u fixed in a and v in b: (u . v)' = (w_a - w_b) . (u x v).
void JointReactions::add_angle_row(std::size_t joint, const MovingEnd& a, const MovingEnd& b, const Vec3& u,
                                   const Vec3& v) {
  const double bias = centripetal(a, u).dot(v) + 2 * a.w.cross(u).dot(b.w.cross(v)) + u.dot(centripetal(b, v));
  add_row(joint, a, b, Vec3::Zero(), u.cross(v), -bias);
}

void JointReactions::add_rows_of(std::size_t joint, BodyColumns bodies) {
  const JointGeometry& geometry = joints_[joint];
  const MovingEnd a = end_motion(geometry.a(), bodies), b = end_motion(geometry.b(), bodies);
  const auto add_distance_row = [&](const DistanceJoint&) {
    const Vec3 apart = b.point() - a.point(), n = apart.normalized(), rate = b.point_velocity() - a.point_velocity();
    const double turning = (rate - n.dot(rate) * n).squaredNorm() / apart.norm();
    add_row(joint, a, b, n, Vec3::Zero(), turning + n.dot(centripetal(b, b.arm) - centripetal(a, a.arm)));
  };
  const auto share_point = [&] {
    for (int k = 0; k < 3; ++k) add_point_row(joint, a, b, Vec3::Unit(k));
  };
  const auto add_universal_rows = [&](const UniversalJoint&) {
    share_point();
    add_angle_row(joint, a, b, a.axis, b.axis);
  };
  const auto add_masked_rows = [&]<typename Type>(const Type&) {
    constexpr unsigned locks = Type::descriptor().locks.value(), turns = locks & Lock::turns;
    if ((locks & Lock::shifts) == Lock::shifts) share_point();
    if ((locks & Lock::shifts) == Lock::across) {
      const Vec3 offset = b.point() - a.centre, rate = b.point_velocity() - a.velocity;
      for (const Vec3& n : across(a.axis))
        add_row(joint, a, b, n, Vec3::Zero(),
                centripetal(a, n).dot(offset) + 2 * a.w.cross(n).dot(rate) + n.dot(centripetal(b, b.arm)));
    }
    if (turns == Lock::tilt)
      for (const Vec3& u : across(a.axis)) add_angle_row(joint, a, b, u, b.axis);
    if (turns != Lock::turns) return;
    // Three axes of one stay at right angles to one each of the other, as at t = 0.
    const Mat3 like_a = b.R * geometry.start_turn().conjugate().toRotationMatrix();
    for (int k = 0; k < 3; ++k) add_angle_row(joint, a, b, a.R.col(k), like_a.col((k + 1) % 3));
  };
  // Of the others nothing is said: see why_reactions_are_unknown().
  std::visit(ForJoints{add_distance_row, add_universal_rows, add_masked_rows,
                       LackingJoints<void, CompoundAxis, CompoundJoint, PlanarJoint, ScrewJoint>()},
             scene_.joints[joint].type);
}

void JointReactions::find_rows(BodyColumns bodies) {
  rows_.clear(), held_.clear();
  for (std::size_t k = 0; k < joints_.size(); ++k) add_rows_of(k, bodies);
  for (std::size_t i = 0; i < order_.size(); ++i) {
    if (order_[i] < 0) continue;
    const Inertia& body = system_.bodies[i];
    const Mat3 R = bodies.rotation(i);
    Rows::InverseMass& inverse = inverse_mass_[order_[i]];
    inverse.setZero();
    inverse.topLeftCorner<3, 3>() = body.inverse_mass * Mat3::Identity();
    inverse.bottomRightCorner<3, 3>() = R * body.inverse_inertia_B * R.transpose();
  }
  is_regular_ = solver_.factorise(rows_, inverse_mass_);
}

// The multipliers of the rows in use, as each row's effect on its joint. The joints take the place of bodies, each with
// unit mass.
std::vector<JointReaction> JointReactions::carried(const std::vector<double>& residuals) {
  std::vector<Row> of_joints(rows_.size());
  for (std::size_t r = 0; r < rows_.size(); ++r) {
    of_joints[r].body[0] = static_cast<int>(held_[r].joint);
    of_joints[r].block[0] << held_[r].force, held_[r].couple;
    of_joints[r].bias = residuals[r];
  }
  const std::vector<Rows::InverseMass> unit(joints_.size(), Rows::InverseMass::Identity());
  const std::vector<Block> sums = solver_.correction(of_joints, unit, [](const Row& row) { return row.bias; });
  std::vector<JointReaction> reactions;
  for (const Block& sum : sums) reactions.push_back({sum.head<3>(), sum.tail<3>()});
  return reactions;
}

std::optional<std::vector<JointReaction>> JointReactions::at(BodyColumns bodies, double t) {
  find_rows(bodies);
  if (!is_regular_) return {};
  Wrenches wrenches;
  system_.wrenches(bodies, t, 0, wrenches);
  std::vector<Block> free(inverse_mass_.size(), Block::Zero());
  for (std::size_t i = 0; i < order_.size(); ++i) {
    if (order_[i] < 0) continue;
    const Inertia& body = system_.bodies[i];
    free[order_[i]] << body.inverse_mass * wrenches[i].force,
        angular_acceleration(body, bodies.rotation(i), bodies.angular_velocity(i), wrenches[i].torque);
  }
  std::vector<double> residuals;
  for (const Row& row : rows_) residuals.push_back(row.rate(free) + row.bias);
  return carried(residuals);
}

// A row d that is left out is minus a combination of those in use: with S λ = -J M⁻¹ Jᵀ e_d, λ + e_d is a load in
// balance.
std::optional<std::vector<UniqueReaction>> JointReactions::unique() {
  if (!is_regular_) return {};
  std::vector<Mat3> forces(joints_.size(), Mat3::Zero()), couples = forces, can_push = forces, can_turn = forces;
  for (const Held& held : held_) {
    can_push[held.joint] += held.force * held.force.transpose();
    can_turn[held.joint] += held.couple * held.couple.transpose();
  }
  const std::vector<int>& chosen = solver_.choice().chosen;
  for (std::size_t d = 0; d < rows_.size(); ++d) {
    if (std::binary_search(chosen.begin(), chosen.end(), static_cast<int>(d))) continue;
    std::vector<Block> moved(inverse_mass_.size(), Block::Zero());
    for (int k = 0; k < 2; ++k) {
      if (const int body = rows_[d].body[k]; body >= 0) moved[body] += inverse_mass_[body] * rows_[d].block[k];
    }
    std::vector<double> residuals;
    for (const Row& row : rows_) residuals.push_back(row.rate(moved));
    std::vector<JointReaction> loads = carried(residuals);
    loads[held_[d].joint].force += held_[d].force, loads[held_[d].joint].couple += held_[d].couple;
    double largest = 0;
    for (const JointReaction& load : loads) largest = std::max({largest, load.force.norm(), load.couple.norm()});
    for (std::size_t k = 0; k < loads.size(); ++k) {
      forces[k] += loads[k].force * loads[k].force.transpose() / (largest * largest);
      couples[k] += loads[k].couple * loads[k].couple.transpose() / (largest * largest);
    }
  }
  std::vector<UniqueReaction> unique;
  for (std::size_t k = 0; k < joints_.size(); ++k)
    unique.push_back({unique_directions(forces[k], can_push[k]), unique_directions(couples[k], can_turn[k])});
  return unique;
}

}  // namespace rigor::inline metric
