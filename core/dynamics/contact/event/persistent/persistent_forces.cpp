#include "core/dynamics/contact/event/persistent/persistent_forces.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace rigor::inline dynamics {
namespace {

constexpr double kNoSlip = 1e-6;  // in the scene's units of speed: a slip that has no direction of its own yet
constexpr double kFading = 10;    // times kNoSlip: a slip that has its own direction, but for a third of kNoSlip

// m/s. A smaller unit would only ask for shorter steps: what is left of it is below the other thresholds.
double unit_of_slip(const ContactScales& scales) {
  constexpr double kLeastFactor = 0.25;
  return std::max(scales.factor, kLeastFactor) * scales.speed_unit();
}

// Unit, in W: the direction against which friction acts. Past the instant of a stop it continues unchanged, so that the
// instant can be found; a slip against its initial direction is mirrored. The direction thus never jumps when joints
// turn a slip by a right angle before it stops. If friction jumped so that both sides lead back to the jump, no step of
// an adaptive method would be short enough.
//
// Near rest the direction is that of slip + kNoSlip d, with d the initial direction. Friction turns the direction of a
// slip u within u m/(mu f_n), so a slip that begins or ends would need ever shorter steps. At a hundred times that
// speed the effect is below rounding.
Vec3 braked_direction(const PersistentPoint& point, double unit) {
  const Vec3 slip = point.frame.rightCols<2>() * point.velocity.tail<2>();
  const double along = slip.dot(point.slip_direction), size = slip.norm() / (kFading * kNoSlip * unit);
  const Vec3 ahead = along < 0 ? Vec3(slip - 2 * along * point.slip_direction) : slip;
  return (ahead + kNoSlip * unit * portable::exp(-size * size) * point.slip_direction).normalized();
}

}  // namespace

PersistentForces::PersistentForces(const System& system, const ContactPoints& contact_points, Joints* joints)
    : system_(system),
      contact_points_(contact_points),
      joints_(joints),
      equations_(joints != nullptr),
      place_(system.size(), -1),
      largest_(system.size()) {
  if (joints_) through_joints_.emplace(system, *joints_);
  for (const Inertia& body : system.bodies) {
    const Mat3 root = body.fixed ? Mat3::Zero().eval() : Mat3(body.inverse_inertia_B.llt().matrixL());
    inertia_root_B_.push_back(root);
  }
  wrench_.resize(kWrenchColumns, system.size());
}

void PersistentForces::begin_attempt() {
  largest_.assign(system_.size(), {});
  for (PersistentPoint& point : points_) point.least_slip = point.largest_slip = 0;
  find_islands();
}

void PersistentForces::find_islands() {
  for (const Island& island : islands_) {
    for (const int body : island.bodies) place_[body] = -1;
  }
  std::vector<std::pair<int, int>> pairs;
  for (const PersistentPoint& point : points_) pairs.emplace_back(point.contact.cone.a, point.contact.cone.b);
  islands_ = islands_of(system_, pairs, joints_);
  for (const Island& island : islands_) {
    for (std::size_t k = 0; k < island.bodies.size(); ++k) place_[island.bodies[k]] = static_cast<int>(k);
  }
}

void PersistentForces::place(BodyColumns state) {
  const std::vector<Collider>& colliders = contact_points_.colliders();
  for (PersistentPoint& point : points_) {
    if (point.contact.is_limit()) {
      place_limit(state, point);
      continue;
    }
    const ConeConstraint& cone = point.contact.cone;
    const RigidMotion a = motion_of(state, colliders[point.contact.a]),
                      b = motion_of(state, colliders[point.contact.b]);
    point.kinematics = contact_kinematics(point.features, a, b);
    const ContactKinematics& kinematics = point.kinematics;
    point.frame = contact_frame(kinematics.normal);
    point.arm_a = kinematics.point - state.position(cone.a), point.arm_b = kinematics.point - state.position(cone.b);
    const auto velocity = [&](const RigidMotion& body) {
      return Vec3(body.v + body.w.cross(kinematics.point - body.pose.p));
    };
    const Vec3 of_a = velocity(a), of_b = velocity(b), u = of_a - of_b;
    const Vec3 bias = a.w.cross(kinematics.point_rate - a.v) - b.w.cross(kinematics.point_rate - b.v);
    point.velocity = point.frame.transpose() * u;
    point.bias = point.frame.transpose() * bias + Vec3(kinematics.normal_rate.dot(u), 0, 0);
    point.slip = (u - kinematics.normal * kinematics.normal.dot(u)).dot(point.slip_direction);
    point.least_slip = std::min(point.least_slip, point.slip);
    point.largest_slip = std::max(point.largest_slip, point.slip);
  }
}

// Its gap is not needed: a kept coordinate rotates little.
void PersistentForces::place_limit(BodyColumns state, PersistentPoint& point) const {
  const JointLimits::Value at = contact_points_.limits().at(point.contact.feature, state);
  point.kinematics.normal = at.direction;
  point.frame = contact_frame(at.direction);
  point.arm_a = at.arm_a, point.arm_b = at.arm_b;
  point.velocity = Vec3(at.rate, 0, 0), point.bias = Vec3(at.bias, 0, 0);
}

void PersistentForces::add_row(std::size_t point, int axis, const Vec3& direction, const Vec3& force, double bias) {
  const PersistentPoint& at = points_[point];
  const ConeConstraint cone = at.cone();
  ForceEquations::Row row;
  row.point = point, row.axis = axis;
  for (int end = 0; end < 2; ++end) {
    const int body = end == 0 ? cone.a : cone.b, place = body == kWorld ? -1 : place_[body];
    if (place < 0) continue;
    const double root = std::sqrt(system_.bodies[body].inverse_mass);
    const auto scaled = [&](const Vec6& of) {
      return joined(root * of.head<3>(), root_W_[place].transpose() * of.tail<3>());
    };
    ForceEquations::Side& side = row.side[end];
    side.place = place;
    side.of_J = scaled(cone.row(end, direction)), side.of_P = scaled(cone.row(end, force));
  }
  if (row.square() == 0) return;
  row.bias = bias;
  if (joints_) row.response = response_to(cone, force);
  equations_.add(std::move(row), direction == force);
}

Eigen::VectorXd PersistentForces::response_to(const ConeConstraint& at, const Vec3& force) {
  const std::vector<int> moved = through_joints_->moved_by(at.a, at.b);
  const std::vector<Vec6>& change = through_joints_->of(moved, at.a, at.row(0, force), at.b, at.row(1, force));
  Eigen::VectorXd response = Eigen::VectorXd::Zero(6 * static_cast<Eigen::Index>(island_.size()));
  for (const int body : moved) {
    const int place = place_[body];
    response.segment<3>(6 * place) = std::sqrt(system_.bodies[body].mass) * change[body].head<3>();
    response.segment<3>(6 * place + 3) = root_W_[place].inverse() * change[body].tail<3>();
  }
  return response;
}

// For velocities, if no slip has begun yet: their rows have no bias.
void PersistentForces::list_rows(const Island& island, Slips slips) {
  equations_.clear();
  for (const std::size_t i : island.points) {
    const PersistentPoint& point = points_[i];
    const Vec3 n = point.kinematics.normal;
    const Vec3 bias = slips == Slips::as_chosen ? point.bias : Vec3::Zero();
    const bool stands = slips == Slips::not_yet && point.begins_to_slip;
    if (point.mode == PersistentPoint::Mode::sticks || stands) {
      for (int axis = 0; axis < 3; ++axis) add_row(i, axis, point.frame.col(axis), point.frame.col(axis), bias[axis]);
      continue;
    }
    if (point.friction() == 0) {
      add_row(i, 0, n, n, bias[0]);
      continue;
    }
    add_row(i, 0, n, n - point.friction() * braked_direction(point, unit_of_slip(scales())), bias[0]);
  }
}

std::pair<Vec3, Vec3> PersistentForces::free_acceleration(BodyColumns state, const double* wrench, int body) const {
  const Inertia& inertia = system_.bodies[body];
  if (inertia.fixed) return {Vec3::Zero(), Vec3::Zero()};
  Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
  for (int k = 0; k < 3 && wrench; ++k) {
    force[k] = wrench[static_cast<std::size_t>(kForce + k) * wrench_.stride() + body];
    torque[k] = wrench[static_cast<std::size_t>(kTorque + k) * wrench_.stride() + body];
  }
  const Mat3 R = state.has_rotation() ? state.rotation(body) : matrix_of(state.orientation(body).normalized());
  return {system_.scene_gravity + inertia.inverse_mass * force,
          angular_acceleration(inertia, R, state.angular_velocity(body), torque)};
}

double PersistentForces::normal_acceleration(BodyColumns state, const double* total,
                                             const PersistentPoint& point) const {
  const auto along = [&](int body, const Vec3& arm) {
    if (body == kWorld) return 0.0;
    const auto [linear, angular] = free_acceleration(state, total, body);
    const Vec3 of_point = point.contact.cone.is_couple ? angular : Vec3(linear + angular.cross(arm));
    return point.kinematics.normal.dot(of_point);
  };
  return along(point.contact.cone.a, point.arm_a) - along(point.contact.cone.b, point.arm_b) + point.bias.x();
}

double PersistentForces::distance_from_ends(BodyColumns state, const PersistentPoint& point) const {
  if (point.contact.is_limit()) return std::numeric_limits<double>::infinity();
  const Collider &a = contact_points_.colliders()[point.contact.a], &b = contact_points_.colliders()[point.contact.b];
  return rigor::distance_from_ends(point.features, point.kinematics, a, pose_of(state, a.body), b,
                                   pose_of(state, b.body));
}

bool PersistentForces::has_friction_of_slip() const {
  return std::any_of(points_.begin(), points_.end(), [](const PersistentPoint& point) {
    return point.mode == PersistentPoint::Mode::slides && point.friction() > 0;
  });
}

double PersistentForces::largest_force() const {
  double largest = 0;
  for (const PersistentPoint& point : points_) largest = std::max(largest, point.force.norm());
  return largest;
}

// The island at hand, with rates of its bodies (linear and angular) in units in which M is 1.
template <typename RatesOf>
Eigen::VectorXd PersistentForces::take_up(const Island& island, BodyColumns state, const RatesOf& rates_of) {
  island_ = island.bodies;
  root_W_.resize(island.bodies.size());
  Eigen::VectorXd rates(6 * island.bodies.size());
  for (std::size_t k = 0; k < island.bodies.size(); ++k) {
    const int body = island.bodies[k];
    const Mat3 R = state.has_rotation() ? state.rotation(body) : matrix_of(state.orientation(body).normalized());
    root_W_[k] = R * inertia_root_B_[body];
    const auto [linear, angular] = rates_of(body);
    rates.segment<3>(6 * static_cast<Eigen::Index>(k)) = std::sqrt(system_.bodies[body].mass) * linear;
    // The root's inverse: G⁻¹ = Gᵀ I.
    rates.segment<3>(6 * static_cast<Eigen::Index>(k) + 3) =
        inertia_root_B_[body].transpose() * (system_.bodies[body].inertia_B * (R.transpose() * angular));
  }
  return rates;
}

void PersistentForces::stop(MutableBodyColumns state) {
  find_islands();
  if (joints_) {
    joints_->velocity_impulse(state);  // for its factor
    through_joints_->set_pose(state);
  }
  for (const Island& island : islands_) {
    const Eigen::VectorXd before = take_up(island, state, [&](int body) {
      return std::pair<Vec3, Vec3>(state.velocity(body), state.angular_velocity(body));
    });
    list_rows(island, Slips::not_yet);
    equations_.solve(before);
    const Eigen::VectorXd change = equations_.accelerations(before) - before;
    for (std::size_t k = 0; k < island.bodies.size(); ++k) {
      const int body = island.bodies[k];
      if (system_.bodies[body].fixed) continue;
      const auto at = 6 * static_cast<Eigen::Index>(k);
      state.set_velocity(body,
                         state.velocity(body) + std::sqrt(system_.bodies[body].inverse_mass) * change.segment<3>(at));
      state.set_angular_velocity(body, state.angular_velocity(body) + root_W_[k] * change.segment<3>(at + 3));
    }
  }
}

void PersistentForces::solve(const Island& island, BodyColumns state, const double* wrench) {
  const Eigen::VectorXd free = take_up(island, state, [&](int body) { return free_acceleration(state, wrench, body); });
  list_rows(island, Slips::as_chosen);
  equations_.solve(free);
  for (const std::size_t i : island.points) points_[i].force.setZero();
  set_forces();
  if (joints_) add_wrenches_through_joints(island, free.size());
}

// M times the accelerations by the rows: by their own forces, and by the joint forces that follow.
void PersistentForces::add_wrenches_through_joints(const Island& island, Eigen::Index size) {
  const Eigen::VectorXd accelerations = equations_.accelerations_through_joints(size);
  for (std::size_t k = 0; k < island.bodies.size(); ++k) {
    const int body = island.bodies[k];
    const auto at = 6 * static_cast<Eigen::Index>(k);
    const Vec3 force = std::sqrt(system_.bodies[body].mass) * accelerations.segment<3>(at);
    const Vec3 torque = root_W_[k].inverse().transpose() * accelerations.segment<3>(at + 3);
    for (int c = 0; c < 3; ++c) {
      wrench_.column(static_cast<std::size_t>(kForce + c))[body] += force[c];
      wrench_.column(static_cast<std::size_t>(kTorque + c))[body] += torque[c];
    }
    now_[body].force += force.norm(), now_[body].torque += torque.norm();
  }
}

void PersistentForces::set_forces() {
  for (const ForceEquations::Row& row : equations_.rows()) {
    PersistentPoint& point = points_[row.point];
    point.force[row.axis] += row.multiplier;
    if (point.mode == PersistentPoint::Mode::sticks || point.friction() == 0) continue;
    point.force -=
        point.friction() * row.multiplier * (point.frame.transpose() * braked_direction(point, unit_of_slip(scales())));
  }
}

void PersistentForces::copy_wrench(const double* wrench) {
  for (std::size_t c = 0; c < kWrenchColumns; ++c) {
    double* const to = wrench_.column(c);
    if (wrench)
      std::copy_n(wrench + c * wrench_.stride(), system_.size(), to);
    else
      std::fill_n(to, system_.size(), 0.0);
  }
  now_.assign(system_.size(), {});
}

// The joint loads, and the springs, dampers and motors on joints.
void PersistentForces::note_loads_of_joints(const double* wrench) {
  const bool are_driven = system_.loads.drives_joints();
  for (std::size_t i = 0; i < system_.size(); ++i) {
    const int body = static_cast<int>(i);
    if (joints_->component_of(body) < 0) continue;
    const Vec6 load = wrench ? wrench_at(wrench, wrench_.stride(), body) : Vec6::Zero().eval();
    const Vec6 held = wrench_at(wrench_.data(), wrench_.stride(), body) - load;
    now_[i] = {held.head<3>().norm(), held.tail<3>().norm()};
    if (are_driven) now_[i].force += load.head<3>().norm(), now_[i].torque += load.tail<3>().norm();
  }
}

// The effect of each point on its two bodies; those through joints are already known.
void PersistentForces::add_pushes() {
  for (const PersistentPoint& point : points_) {
    const Vec3 force = point.frame * point.force;
    for (int end = 0; end < 2 && !joints_; ++end) {
      const int body = end == 0 ? point.contact.cone.a : point.contact.cone.b;
      if (place_[body] < 0) continue;
      const Vec3 push = end == 0 ? force : Vec3(-force), turn = (end == 0 ? point.arm_a : point.arm_b).cross(push);
      for (int k = 0; k < 3; ++k) {
        wrench_.column(static_cast<std::size_t>(kForce + k))[body] += push[k];
        wrench_.column(static_cast<std::size_t>(kTorque + k))[body] += turn[k];
      }
      now_[body].force += push.norm(), now_[body].torque += turn.norm();
    }
  }
  for (std::size_t i = 0; i < now_.size(); ++i) {
    Loading& most = largest_[i];
    most.force = std::max(most.force, now_[i].force), most.torque = std::max(most.torque, now_[i].torque);
  }
}

const double* PersistentForces::hold(BodyColumns state, const double* wrench, Rows rows) {
  ++times_asked_;
  place(state);
  copy_wrench(joints_ ? joints_->hold(state, wrench, rows) : wrench);
  if (joints_) {
    note_loads_of_joints(wrench);
    through_joints_->set_pose(state);
  }
  for (const Island& island : islands_) solve(island, state, wrench_.data());
  add_pushes();
  return wrench_.data();
}

}  // namespace rigor::inline dynamics
