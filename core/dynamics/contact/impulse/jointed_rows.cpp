#include "core/dynamics/contact/impulse/jointed_rows.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/contact/impulse/rebounds/impact_energy.h"

namespace rigor::inline dynamics {
namespace {

constexpr int kSweeps = 4;  // over all rows, in each of the two passes
// rad: a limit that is farther away is no soft one. Only if its lever [m] were shorter than a ten millionth of the
// scene's length would it touch.
constexpr double kFarAngle = 1e-3;

}  // namespace

JointedRows::JointedRows(const Scene& scene, const System& system, Joints& joints)
    : system_(system),
      joints_(joints),
      through_joints_(system, joints),
      place_(system.size()),
      velocities_(system.size(), Vec6::Zero()),
      loaded_(velocities_) {
  place_bodies();
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    const Joint& joint = scene.joints[k];
    std::vector<Motor> motors;
    for (const Motor& motor : scene.motors) {
      if (motor.joint == static_cast<int>(k) && motor.speed) motors.push_back(motor);
    }
    if (joint.has_limits() || !motors.empty())
      coordinates_.push_back({JointCoordinate(scene, joint), joint.lower, joint.upper, joint.restitution, motors});
  }
}

void JointedRows::assign(BodyColumns state, const std::vector<ContactConstraint>& contacts, double impulse_scale) {
  pose_ = state;
  through_joints_.set_pose(std::as_const(pose_).columns());
  factorise();
  rows_.clear(), responses_.clear();
  for (const ContactConstraint& contact : contacts) {
    Row row = contact_row(state, contact);
    row.impulse[0] = impulse_scale * contact.normal_impulse;
    for (int d = 1; d < 3; ++d) row.impulse[d] = impulse_scale * row.J[d][0].head<3>().dot(contact.friction_impulse);
    rows_.push_back(row);
  }
  contacts_ = rows_.size();
  for (Coordinate& at : coordinates_) {
    at.first_row = rows_.size();
    const JointCoordinate::Value value = at.coordinate.at(state);
    for (const double sign : {1.0, -1.0, 1.0})
      rows_.push_back(coordinate_row(at.coordinate, value, sign, at.restitution));
    rows_.back().is_motor = true;
    rows_[at.first_row].impulse[0] = impulse_scale * at.lower_impulse;
    rows_[at.first_row + 1].impulse[0] = impulse_scale * at.upper_impulse;
    rows_[at.first_row + 2].impulse[0] = impulse_scale * at.motor_impulse;
  }
  are_restitutions_ = std::any_of(rows_.begin(), rows_.end(), [](const Row& row) { return row.restitution > 0; });
  for (Row& row : rows_) {
    if (std::any_of(row.impulse, row.impulse + row.directions, [](double p) { return p != 0; })) know(row);
  }
}

void JointedRows::store_impulses(std::vector<ContactConstraint>& contacts) {
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    const Row& row = rows_[i];
    contacts[i].normal_impulse = row.impulse[0];
    contacts[i].friction_impulse = row.impulse[1] * row.J[1][0].head<3>() + row.impulse[2] * row.J[2][0].head<3>();
  }
  for (Coordinate& at : coordinates_) {
    at.lower_impulse = rows_[at.first_row].impulse[0], at.upper_impulse = rows_[at.first_row + 1].impulse[0];
    at.motor_impulse = rows_[at.first_row + 2].impulse[0];
  }
}

void JointedRows::add_impulses(Vec3* impulses) const {
  for (std::size_t i = 0; i < contacts_; ++i) {
    const Row& row = rows_[i];
    for (int d = 0; d < row.directions; ++d) {
      const double of_restitution = row.impulse[d] - row.without_restitution[d];
      impulses[i] += (row.without_restitution[d] + restitution_share_ * of_restitution) * row.J[d][0].head<3>();
    }
  }
}

JointedRows::Row JointedRows::contact_row(BodyColumns state, const ContactConstraint& contact) const {
  Row row{.body = {contact.a, contact.b}, .directions = 3};
  const Vec3 n = contact.normal, t = n.unitOrthogonal(), s = n.cross(t);
  const Vec3 arms[2] = {contact.arm_a, contact.arm_b};
  for (int end = 0; end < 2; ++end) {
    const double sign = end == 0 ? 1 : -1;
    int d = 0;
    for (const Vec3& direction : {n, t, s}) row.J[d++][end] = sign * joined(direction, arms[end].cross(direction));
    row.arm_B[end] = state.rotation(row.body[end]).transpose() * arms[end];
  }
  row.normal = n;
  row.apart = state.position(contact.a) + contact.arm_a - state.position(contact.b) - contact.arm_b;
  row.initial_gap = contact.gap;
  row.friction = contact.friction, row.restitution = contact.restitution;
  return row;
}

// The row of x for a lower limit and a motor, of -x for an upper limit.
JointedRows::Row JointedRows::coordinate_row(const JointCoordinate& coordinate, const JointCoordinate::Value& at,
                                             double sign, double restitution) const {
  Row row{.body = {coordinate.a(), coordinate.b()}, .directions = 1};
  row.turns = coordinate.turns();
  row.J[0][0] = sign * joined(-at.force, at.torque_a);
  row.J[0][1] = sign * joined(at.force, at.torque_b);
  row.restitution = restitution;
  return row;
}

// Whether it touches or could within the sub-step. A row that does not has no part in impacts and is not soft.
bool JointedRows::may_act(const Row& row) const {
  const double near = row.turns ? kFarAngle : parameters_.touching;
  return !row.is_motor && (row.gap <= near || row.gap < 2 * parameters_.h * row.approach);
}

void JointedRows::load_velocities(BodyColumns state) {
  for (std::size_t i = 0; i < state.size(); ++i) loaded_[i] = joined(state.velocity(i), state.angular_velocity(i));
  for (std::size_t i = 0; i < state.size(); ++i) velocities_[place_[i]] = loaded_[i];
  if (are_restitutions_) energy_before_ = twice_energy_of(system_, state, loaded_);
}

double JointedRows::speed(const Row& row, int direction) const {
  double sum = 0;
  for (int end = 0; end < 2; ++end) {
    if (row.body[end] != kWorld)
      sum += row.J[direction][end].dot(velocities_[place_[static_cast<std::size_t>(row.body[end])]]);
  }
  return sum;
}

void JointedRows::apply(const Row& row, int direction, double impulse) {
  using Numbers = Eigen::Map<Eigen::VectorXd>;
  const std::size_t count = row.moved[0].count + row.moved[1].count;
  const Vec6* by = responses_.data() + row.responses + static_cast<std::size_t>(direction) * count;
  for (const Span& span : row.moved) {
    const auto numbers = static_cast<Eigen::Index>(6 * span.count);
    Numbers(velocities_[span.first].data(), numbers) +=
        impulse * Eigen::Map<const Eigen::VectorXd>(by->data(), numbers);
    by += span.count;
  }
}

double JointedRows::contact_gap(const Row& row, BodyColumns state) const {
  Vec3 point[2];
  for (int end = 0; end < 2; ++end)
    point[end] = state.position(row.body[end]) + state.rotation(row.body[end]) * row.arm_B[end];
  return row.initial_gap + row.normal.dot(point[0] - point[1] - row.apart);
}

void JointedRows::prepare_coordinate(Coordinate& at, BodyColumns state, double t) {
  at.x = at.coordinate.with_turns(at.coordinate.at(state).x, at.x);
  rows_[at.first_row].gap = at.x - at.lower, rows_[at.first_row + 1].gap = at.upper - at.x;
  at.speed = at.most_impulse = 0;
  for (const Motor& motor : at.motors) {
    const double share = share_of_step(motor.from, motor.until, t, parameters_.h);
    if (share > 0) at.speed = *motor.speed, at.most_impulse = share * motor.most * parameters_.h;
  }
}

void JointedRows::prepare(BodyColumns state, double t, const SolverParameters& parameters) {
  parameters_ = parameters;
  load_velocities(state);
  for (std::size_t i = 0; i < contacts_; ++i) rows_[i].gap = contact_gap(rows_[i], state);
  for (Coordinate& at : coordinates_) prepare_coordinate(at, state, t);
  for (Row& row : rows_) {
    row.approach = -speed(row, 0);
    if (!row.is_known && may_act(row)) know(row);
    row.bias = bias_of(row);
    row.is_impact = row.is_known && !row.is_motor && row.lever * row.approach > parameters.restitution_threshold &&
                    row.gap < 2 * parameters.h * row.approach;
  }
}

// Speculative: the gap closes by h (theta u' + (1 - theta) u), of which only the velocity after, u', can be chosen.
double JointedRows::bias_of(const Row& row) const {
  const double theta = parameters_.theta;
  if (!is_soft(row)) return std::max(0.0, row.gap) / (parameters_.h * theta) - (1 - theta) / theta * row.approach;
  return std::max(-parameters_.max_push_speed / row.lever, parameters_.bias_rate * row.gap);
}

void JointedRows::warm_start() {
  is_factor_here_ = false;  // the integrator has used the joints since
  for (const Row& row : rows_) {
    for (int d = 0; d < row.directions; ++d) {
      if (row.impulse[d] != 0) apply(row, d, row.impulse[d]);
    }
  }
}

void JointedRows::solve_normal(Row& row, double impulse) {
  const double change = std::max(0.0, impulse) - row.impulse[0];
  if (change == 0) return;
  apply(row, 0, change);
  row.impulse[0] += change;
}

void JointedRows::solve_friction(Row& row) {
  if (row.directions == 1 || (row.impulse[0] == 0 && row.impulse[1] == 0 && row.impulse[2] == 0)) return;
  const double radius = row.impulse[0] > 0 ? row.friction * row.impulse[0] : 0;
  const Vec2 old(row.impulse[1], row.impulse[2]), slip(speed(row, 1), speed(row, 2));
  const Vec2 p = onto_disc(old, slip, row.tangent_mass, radius);
  apply(row, 1, p.x() - old.x()), apply(row, 2, p.y() - old.y());
  row.impulse[1] = p.x(), row.impulse[2] = p.y();
}

void JointedRows::solve_biased(Row& row) {
  if (!row.is_known) {
    if (speed(row, 0) + row.bias >= 0) return;  // it would get no impulse
    know(row);
  }
  const bool soft = is_soft(row);
  const double mass_scale = soft ? parameters_.mass_scale : 1, impulse_scale = soft ? parameters_.impulse_scale : 0;
  const double p = row.impulse[0];
  solve_normal(row, p - mass_scale * (speed(row, 0) + row.bias) * row.mass - impulse_scale * p);
  solve_friction(row);
}

void JointedRows::solve_motors() {
  for (const Coordinate& at : coordinates_) {
    Row& row = rows_[at.first_row + 2];
    if (at.most_impulse == 0 && row.impulse[0] == 0) continue;
    if (!row.is_known) know(row);
    const double p =
        std::clamp(row.impulse[0] - (speed(row, 0) - at.speed) * row.mass, -at.most_impulse, at.most_impulse);
    apply(row, 0, p - row.impulse[0]);
    row.impulse[0] = p;
  }
}

// Visits contacts and limits.
template <typename Visit>
void JointedRows::for_each_one_sided(const Visit& visit) {
  for (const Coordinate& at : coordinates_) visit(rows_[at.first_row]), visit(rows_[at.first_row + 1]);
  for (std::size_t i = 0; i < contacts_; ++i) visit(rows_[i]);
}

void JointedRows::solve_with_bias() {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    solve_motors();
    for_each_one_sided([&](Row& row) { solve_biased(row); });
  }
  sweep_impacts([&](Row& row) { solve_biased(row); });
}

void JointedRows::relax() {
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    solve_motors();
    for_each_one_sided([&](Row& row) {
      if (row.impulse[0] <= 0) return;
      solve_normal(row, row.impulse[0] - speed(row, 0) * row.mass);
      solve_friction(row);
    });
  }
}

void JointedRows::apply_restitution(BodyColumns state) {
  for (Row& row : rows_) std::copy(std::begin(row.impulse), std::end(row.impulse), row.without_restitution);
  restitution_share_ = 1;
  if (!are_restitutions_) return;
  const std::vector<Vec6> without = by_body();
  sweep_impacts([&](Row& row) {
    if (row.restitution == 0 || row.impulse[0] == 0) return;
    solve_normal(row, row.impulse[0] + (row.restitution * row.approach - speed(row, 0)) * row.mass);
    solve_friction(row);
  });
  std::vector<Vec6> with = by_body();
  restitution_share_ = limit_energy(system_, state, energy_before_, without, with);
  for (std::size_t i = 0; i < with.size(); ++i) velocities_[place_[i]] = with[i];
}

std::vector<Vec6> JointedRows::by_body() const {
  std::vector<Vec6> velocities(velocities_.size());
  for (std::size_t i = 0; i < velocities.size(); ++i) velocities[i] = velocities_[place_[i]];
  return velocities;
}

// Until no impact's velocity changes by more than the tolerance.
template <typename Solve>
void JointedRows::sweep_impacts(const Solve& solve) {
  for (int sweep = 0; sweep < parameters_.max_sweeps; ++sweep) {
    double largest = 0;
    for_each_one_sided([&](Row& row) {
      if (!row.is_impact) return;
      const double before = speed(row, 0);
      solve(row);
      largest = std::max(largest, row.lever * std::abs(speed(row, 0) - before));
    });
    if (largest <= parameters_.tolerance) return;
  }
}

}  // namespace rigor::inline dynamics
