#include "core/dynamics/contact/impulse/jointed_rows.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/contact/impulse/rebounds/impact_energy.h"

namespace rigor {
namespace {

constexpr int kSweeps = 4;  // over all rows, in each of the two passes

}  // namespace

JointedRows::JointedRows(const Scene& scene, const System& system, Joints& joints)
    : system_(system),
      joints_(joints),
      through_joints_(system, joints),
      velocities_(system.size(), Vec6::Zero()),
      loaded_(velocities_) {
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
  joints_.velocity_impulse(state);  // for its factor
  through_joints_.set_pose(state);
  rows_.clear(), responses_.clear();
  for (const ContactConstraint& contact : contacts) {
    Row row = contact_row(state, contact);
    row.impulse[0] = impulse_scale * contact.normal_impulse;
    for (int d = 1; d < 3; ++d) row.impulse[d] = impulse_scale * row.J[d][0].head<3>().dot(contact.friction_impulse);
    add(row);
  }
  contacts_ = rows_.size();
  for (Coordinate& at : coordinates_) {
    at.first_row = rows_.size();
    const JointCoordinate::Value value = at.coordinate.at(state);
    for (const double sign : {1.0, -1.0, 1.0}) {
      add(coordinate_row(at.coordinate, value, sign, at.restitution));
      rows_.back().lever = lever_of(rows_.back(), at.coordinate);
    }
    rows_[at.first_row].impulse[0] = impulse_scale * at.lower_impulse;
    rows_[at.first_row + 1].impulse[0] = impulse_scale * at.upper_impulse;
    rows_[at.first_row + 2].impulse[0] = impulse_scale * at.motor_impulse;
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
  row.J[0][0] = sign * joined(-at.force, at.torque_a);
  row.J[0][1] = sign * joined(at.force, at.torque_b);
  row.restitution = restitution;
  return row;
}

// With the part of the row's impulses that the joints allow; `ends` are those on one body alone.
void JointedRows::add(Row row) {
  row.first_response = responses_.size();
  const std::vector<int> bodies = through_joints_.moved_by(row.body[0], row.body[1]);
  for (const int body : bodies) responses_.emplace_back().body = body;
  for (int d = 0; d < row.directions; ++d) {
    const std::vector<Vec6>& change = through_joints_.of(bodies, row.body[0], row.J[d][0], row.body[1], row.J[d][1]);
    for (std::size_t i = 0; i < bodies.size(); ++i) responses_[row.first_response + i].by[d] = change[bodies[i]];
  }
  row.last_response = responses_.size();
  find_masses(row);
  rows_.push_back(row);
}

void JointedRows::find_masses(Row& row) const {
  const auto K = [&](int d, int by) {
    double sum = 0;
    for (std::size_t i = row.first_response; i < row.last_response; ++i) {
      for (int end = 0; end < 2; ++end) {
        if (responses_[i].body == row.body[end]) sum += row.J[d][end].dot(responses_[i].by[by]);
      }
    }
    return sum;
  };
  // A row along which the joints allow no motion gets no impulse.
  const auto inverse = [](double k, double scale) { return k > 1e-12 * scale ? 1 / k : 0; };
  const auto scale = [&](int d) {
    double sum = 0;
    for (int end = 0; end < 2; ++end) sum += row.J[d][end].dot(through_joints_.alone(row.body[end], row.J[d][end]));
    return sum;
  };
  row.mass = inverse(K(0, 0), scale(0));
  if (row.directions == 1) return;
  const double tt = K(1, 1), ss = K(2, 2), ts = K(1, 2);
  row.tangent_mass = tangent_mass_of(tt, ss, ts);
  if (tt * ss - ts * ts > 1e-12 * scale(1) * scale(2)) return;
  // The joints leave at most one direction to slip in: one mass for all.
  const double larger = 0.5 * (tt + ss) + std::hypot(0.5 * (tt - ss), ts);
  row.tangent_mass.slip = inverse(larger, scale(1) + scale(2));
  row.tangent_mass.tt = row.tangent_mass.ss = row.tangent_mass.slip, row.tangent_mass.ts = 0;
}

// The radius at which the bodies' mass would have the inertia that the row feels.
double JointedRows::lever_of(const Row& row, const JointCoordinate& coordinate) const {
  if (!coordinate.turns()) return 1;
  double inverse_mass = 0;
  for (const int body : row.body) inverse_mass += body == kWorld ? 0 : system_.bodies[body].inverse_mass;
  return std::sqrt(row.mass * inverse_mass);
}

void JointedRows::load_velocities(BodyColumns state) {
  for (std::size_t i = 0; i < state.size(); ++i) loaded_[i] = joined(state.velocity(i), state.angular_velocity(i));
  velocities_ = loaded_;
  energy_before_ = twice_energy_of(system_, state, velocities_);
}

double JointedRows::speed(const Row& row, int direction) const {
  double sum = 0;
  for (int end = 0; end < 2; ++end) {
    if (row.body[end] != kWorld) sum += row.J[direction][end].dot(velocities_[row.body[end]]);
  }
  return sum;
}

void JointedRows::apply(const Row& row, int direction, double impulse) {
  for (std::size_t i = row.first_response; i < row.last_response; ++i)
    velocities_[responses_[i].body] += impulse * responses_[i].by[direction];
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
    row.bias = bias_of(row);
    row.is_impact =
        row.lever * row.approach > parameters.restitution_threshold && row.gap < 2 * parameters.h * row.approach;
  }
  for (const Coordinate& at : coordinates_) rows_[at.first_row + 2].is_impact = false;
}

// Speculative: the gap closes by h (theta u' + (1 - theta) u), of which only the velocity after, u', can be chosen.
double JointedRows::bias_of(const Row& row) const {
  const double theta = parameters_.theta;
  if (!is_soft(row)) return std::max(0.0, row.gap) / (parameters_.h * theta) - (1 - theta) / theta * row.approach;
  return std::max(-parameters_.max_push_speed / row.lever, parameters_.bias_rate * row.gap);
}

void JointedRows::warm_start() {
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
  const bool soft = is_soft(row);
  const double mass_scale = soft ? parameters_.mass_scale : 1, impulse_scale = soft ? parameters_.impulse_scale : 0;
  const double p = row.impulse[0];
  solve_normal(row, p - mass_scale * (speed(row, 0) + row.bias) * row.mass - impulse_scale * p);
  solve_friction(row);
}

void JointedRows::solve_motors() {
  for (const Coordinate& at : coordinates_) {
    Row& row = rows_[at.first_row + 2];
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
  const std::vector<Vec6> without = velocities_;
  for (Row& row : rows_) std::copy(std::begin(row.impulse), std::end(row.impulse), row.without_restitution);
  sweep_impacts([&](Row& row) {
    if (row.restitution == 0 || row.impulse[0] == 0) return;
    solve_normal(row, row.impulse[0] + (row.restitution * row.approach - speed(row, 0)) * row.mass);
    solve_friction(row);
  });
  restitution_share_ = limit_energy(system_, state, energy_before_, without, velocities_);
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

}  // namespace rigor
