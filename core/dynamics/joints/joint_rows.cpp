#include "core/dynamics/joints/joint_rows.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/joints/small_blocks.h"
#include "core/dynamics/kernels/kernels.h"

namespace rigor::inline dynamics {
namespace {

// Row k of J at both ends.
void set_row(JointRow& joint, int k, const Vec6& on_a, const Vec6& on_b) {
  for (int c = 0; c < 6; ++c) {
    joint.J[0][k + c * joint.most_rows] = on_a[c];
    joint.J[1][k + c * joint.most_rows] = on_b[c];
  }
}

bool has_speed_motor_or_servo(const Scene& scene, std::size_t joint) {
  return std::any_of(scene.motors.begin(), scene.motors.end(), [&](const Motor& motor) {
    return motor.joint == static_cast<int>(joint) && !motor.gives_effort();
  });
}

}  // namespace

Vec6 wrench_at(const double* columns, std::size_t stride, int body) {
  Vec6 wrench;
  for (int c = 0; c < 6; ++c)
    wrench[c] = columns[static_cast<std::size_t>(c) * stride + static_cast<std::size_t>(body)];
  return wrench;
}

JointRows::JointRows(const Scene& scene, const System& system)
    : system_(system),
      joints_(scene.joints.size() + scene.couplings.size()),
      frames_(system.size()),
      on_body_(system.size()),
      elsewhere_(system.size()),
      wrench_(kWrenchColumns, system.size()) {
  for (std::size_t k = 0; k < scene.joints.size(); ++k) add_joint(scene, k);
  for (std::size_t k = 0; k < scene.couplings.size(); ++k)
    add_coupling(scene, scene.couplings[k], joints_[scene.joints.size() + k]);
  std::sort(moved_.begin(), moved_.end());
  moved_.erase(std::unique(moved_.begin(), moved_.end()), moved_.end());
  list_shared_bodies();
}

void JointRows::add_joint(const Scene& scene, std::size_t k) {
  const Joint& joint = scene.joints[k];
  JointRow& row = joints_[k];
  row.constraint = make_constraint(scene, joint);
  row.rows = row.most_rows = row.constraint->rows();
  row.armature = joint.armature;
  // The axis of a compound joint has no rows of its own, and each joint needs room for one.
  if (joint.has_limits() || joint.armature > 0 || has_speed_motor_or_servo(scene, k) || row.rows == 0) {
    row.coordinate.emplace(scene, joint);
    ++row.most_rows;
  }
  row.end[0] = joint.a, row.end[1] = joint.b;
  note_ends(row);
}

void JointRows::add_coupling(const Scene& scene, const Coupling& coupling, JointRow& row) {
  row.coupling = std::make_unique<CoupledCoordinates>(scene, coupling);
  row.rows = row.most_rows = 1;
  row.ends = row.coupling->count();
  std::copy(row.coupling->ends().begin(), row.coupling->ends().end(), row.end);
  note_ends(row);
}

void JointRows::note_ends(JointRow& row) {
  for (int end = 0; end < row.ends; ++end) {
    const int body = row.end[end];
    if (body == kWorld) continue;
    row.body[end] = system_.bodies[body].fixed ? kWorld : body;
    moved_.push_back(body);
  }
}

void JointRows::list_shared_bodies() {
  std::vector<std::vector<std::pair<int, int>>> on_body(system_.size());  // joints and their ends
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    for (int end = 0; end < joints_[k].ends; ++end) {
      if (joints_[k].body[end] != kWorld) on_body[joints_[k].body[end]].emplace_back(k, end);
    }
  }
  for (const auto& ends : on_body) {
    for (std::size_t i = 0; i < ends.size(); ++i) {
      for (std::size_t j = i + 1; j < ends.size(); ++j) {
        shared_.push_back({ends[i].first,
                           ends[j].first,
                           static_cast<std::int8_t>(ends[i].second),
                           static_cast<std::int8_t>(ends[j].second),
                           {}});
      }
    }
  }
}

BlockCholesky JointRows::make_factor() {
  std::vector<int> rows;
  for (const JointRow& joint : joints_) rows.push_back(joint.most_rows);
  std::vector<std::pair<int, int>> coupled;
  for (const SharedBody& c : shared_) coupled.emplace_back(c.first, c.second);
  BlockCholesky factor(rows, coupled);
  for (SharedBody& c : shared_) c.place = factor.place(c.first, c.second);
  for (std::size_t k = 0; k < joints_.size(); ++k) factor.set_rows_in_use(k, joints_[k].rows_in_use());
  return factor;
}

void JointRows::evaluate_frame(int body, BodyColumns state) {
  Frame& frame = frames_[body];
  const Mat3& inverse = system_.bodies[body].inverse_inertia_B;
  frame.motion = {state.position(body), state.rotation(body), state.velocity(body), state.angular_velocity(body)};
  const Mat3& R = frame.motion.R;
  const Mat3 half = R.lazyProduct(inverse);
  frame.inverse_inertia_W = half.lazyProduct(R.transpose());
}

void JointRows::evaluate(BodyColumns state) {
  for (const int body : moved_) evaluate_frame(body, state);
  static const EndMotion kStill;
  for (JointRow& joint : joints_) {
    if (joint.coupling) {
      evaluate_coupling(joint, state);
      continue;
    }
    const EndMotion& a = joint.end[0] == kWorld ? kStill : frames_[joint.end[0]].motion;
    const EndMotion& b = joint.end[1] == kWorld ? kStill : frames_[joint.end[1]].motion;
    ConstraintRow rows[kMostRows];
    joint.constraint->evaluate(a, b, rows);
    for (int k = 0; k < joint.rows; ++k) {
      set_row(joint, k, rows[k].on_a, rows[k].on_b);
      joint.gap[k] = rows[k].gap, joint.bias[k] = rows[k].bias;
    }
    if (joint.coordinate) evaluate_coordinate(joint, state);
  }
}

void JointRows::evaluate_coupling(JointRow& joint, BodyColumns state) {
  const CoupledCoordinates::Row row = joint.coupling->at(state);
  for (int end = 0; end < joint.ends; ++end) {  // one row
    const auto at = static_cast<std::size_t>(end);
    std::copy_n(row.force[at].data(), 3, joint.J[end]), std::copy_n(row.torque[at].data(), 3, joint.J[end] + 3);
  }
  joint.gap[0] = row.gap, joint.bias[0] = row.bias;
}

void JointRows::evaluate_coordinate(JointRow& joint, BodyColumns state) {
  const int k = joint.rows;
  Vec6 on_a = Vec6::Zero(), on_b = Vec6::Zero();
  joint.gap[k] = joint.bias[k] = 0;
  if (joint.has_coordinate_row()) {
    const JointCoordinate::Value at = joint.coordinate->at(state);
    on_a << -at.force, at.torque_a;
    on_b << at.force, at.torque_b;
    joint.bias[k] = at.bias;
    if (joint.row == CoordinateRow::kept)
      joint.gap[k] = joint.coordinate->with_turns(at.x, joint.target) - joint.target;
  }
  set_row(joint, k, on_a, on_b);
}

double JointRows::longest_arm(bool of_moving_ends) const {
  double longest = 0;
  for (const JointRow& joint : joints_) {
    for (int end = 0; end < joint.ends; ++end) {
      if (of_moving_ends && joint.body[end] == kWorld) continue;
      const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 6>> J(joint.J[end], joint.most_rows, 6);
      for (int k = 0; k < joint.rows; ++k) {
        const double force = J.row(k).head<3>().norm();
        if (force > 0) longest = std::max(longest, J.row(k).tail<3>().norm() / force);
      }
    }
  }
  if (longest == 0) longest = longest_distance();
  return longest == 0 ? 1 : longest;
}

double JointRows::longest_distance() const {
  double longest = 0;
  for (const JointRow& joint : joints_) {
    if (joint.coupling) continue;
    const auto at = [&](int end) {
      return joint.end[end] == kWorld ? Vec3(Vec3::Zero()) : frames_[joint.end[end]].motion.position;
    };
    longest = std::max(longest, (at(1) - at(0)).norm());
  }
  return longest;
}

// A row without a force keeps an angle. The row of a coupling keeps what its first coordinate is, and may have a force
// all the same: that of a hinge coupled to a slider.
void JointRows::set_lever(double lever) {
  lever_ = lever;
  for (JointRow& joint : joints_) {
    if (joint.coordinate) joint.keeps_angle[static_cast<std::size_t>(joint.rows)] = joint.coordinate->turns();
    for (int k = 0; k < joint.rows; ++k) {
      double force = 0;
      for (int end = 0; end < joint.ends; ++end)
        for (int c = 0; c < 3; ++c) force = std::max(force, std::abs(joint.J[end][k + c * joint.most_rows]));
      joint.keeps_angle[static_cast<std::size_t>(k)] = joint.coupling ? joint.coupling->turns() : force == 0;
    }
  }
}

double JointRows::largest_force(const std::vector<Vec6>& multipliers, double lever) const {
  double largest = 0;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    for (int row = 0; row < joints_[k].rows_in_use(); ++row) {
      const double size = std::abs(multipliers[k][row]);
      largest = std::max(largest, joints_[k].keeps_angle[static_cast<std::size_t>(row)] ? size / lever : size);
    }
  }
  return largest;
}

void JointRows::assemble(BlockCholesky& factor) {
  factor.clear();
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    JointRow& joint = joints_[k];
    double* const D = factor.diagonal(k).data();
    with_rows(joint.most_rows, [&](auto R) {
      for (int end = 0; end < joint.ends; ++end) {
        const int body = joint.body[end];
        if (body == kWorld) continue;
        const double inverse_mass = system_.bodies[body].inverse_mass;
        double *const J = joint.J[end], *const Y = joint.Y[end];
        for (int i = 0; i < 3 * R; ++i) Y[i] = inverse_mass * J[i];
        std::fill_n(Y + 3 * R, 3 * R, 0.0);
        add_product<R>(Y + 3 * R, J + 3 * R, frames_[body].inverse_inertia_W.data(), 3, 3);  // it is symmetric
        add_product<R>(D, Y, J, R, 6);
      }
    });
    if (joint.carries_rotor()) D[joint.rows * (joint.most_rows + 1)] += 1 / joint.armature;
  }
  for (const SharedBody& c : shared_) {
    const JointRow &first = joints_[c.first], &second = joints_[c.second];
    double* const to = factor.block(c.place.index).data();
    const bool swapped = c.place.transposed;
    const JointRow &row = swapped ? second : first, &column = swapped ? first : second;
    const int row_end = swapped ? c.second_end : c.first_end, column_end = swapped ? c.first_end : c.second_end;
    with_rows(row.most_rows,
              [&](auto R) { add_product<R>(to, row.Y[row_end], column.J[column_end], column.most_rows, 6); });
  }
}

double JointRows::measure_gaps(BodyColumns state) {
  for (const int body : moved_)
    elsewhere_[body].position = state.position(body), elsewhere_[body].R = state.rotation(body);
  static const EndMotion kStill;
  for (JointRow& joint : joints_) {
    if (joint.coupling) {
      joint.gap[0] = joint.coupling->at(state).gap;
      continue;
    }
    const EndMotion& a = joint.end[0] == kWorld ? kStill : elsewhere_[joint.end[0]];
    const EndMotion& b = joint.end[1] == kWorld ? kStill : elsewhere_[joint.end[1]];
    joint.constraint->find_gaps(a, b, joint.gap.data());
    if (!joint.has_coordinate_row()) continue;
    joint.gap[joint.rows] = joint.coordinate->with_turns(joint.coordinate->at(state).x, joint.target) - joint.target;
  }
  return largest_gap();
}

double JointRows::largest_gap() const {
  double largest = 0;
  for (const JointRow& joint : joints_) {
    for (int k = 0, rows = joint.rows_in_use(); k < rows; ++k) {
      const double gap = (joint.keeps_angle[static_cast<std::size_t>(k)] ? lever_ : 1) * std::abs(joint.gap[k]);
      if (!(gap <= largest)) largest = gap;  // true also for NaN
    }
  }
  return largest;
}

const double* JointRows::wrench_of(const std::vector<Vec6>& multipliers) {
  for (const int body : moved_) on_body_[body].setZero();
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const JointRow& joint = joints_[k];
    with_rows(joint.most_rows, [&](auto R) {
      for (int end = 0; end < joint.ends; ++end) {
        if (joint.body[end] != kWorld)
          subtract_transposed_product<R>(on_body_[joint.body[end]].data(), joint.J[end], multipliers[k].data(), 6);
      }
    });
  }
  double* const columns = wrench_.data();
  for (const int body : moved_) {
    for (std::size_t c = 0; c < kWrenchColumns; ++c) columns[c * stride() + body] = -on_body_[body][c];
  }
  return columns;
}

Vec6 JointRows::times_velocity(const JointRow& joint) const {
  Vec6 negative = Vec6::Zero();
  with_rows(joint.most_rows, [&](auto R) {
    for (int end = 0; end < joint.ends; ++end) {
      if (joint.body[end] == kWorld) continue;
      const EndMotion& motion = frames_[joint.body[end]].motion;
      subtract_product<R>(negative.data(), joint.J[end], motion.velocity.data(), 3);
      subtract_product<R>(negative.data(), joint.J[end] + 3 * R, motion.angular_velocity.data(), 3);
    }
  });
  return -negative;
}

Vec6 JointRows::times_acceleration(const JointRow& joint, const std::vector<Vec6>& by_body) const {
  Vec6 negative = Vec6::Zero();
  with_rows(joint.most_rows, [&](auto R) {
    for (int end = 0; end < joint.ends; ++end) {
      if (joint.body[end] != kWorld)
        subtract_product<R>(negative.data(), joint.J[end], by_body[joint.body[end]].data(), 6);
    }
  });
  return -negative;
}

Vec6 JointRows::response(const JointRow& joint, const double* wrench) const {
  Vec6 negative = Vec6::Zero();
  with_rows(joint.most_rows, [&](auto R) {
    for (int end = 0; end < joint.ends; ++end) {
      if (joint.body[end] == kWorld) continue;
      const Vec6 on_body = wrench_at(wrench, stride(), joint.body[end]);
      subtract_product<R>(negative.data(), joint.Y[end], on_body.data(), 6);
    }
  });
  return -negative;
}

double JointRows::response_size(const JointRow& joint, const double* wrench) const {
  Vec6 size = Vec6::Zero();
  for (int end = 0; end < joint.ends; ++end) {
    if (joint.body[end] == kWorld) continue;
    const Vec6 on_body = wrench_at(wrench, stride(), joint.body[end]);
    const Eigen::Map<const Eigen::MatrixXd> Y(joint.Y[end], joint.most_rows, 6);
    size.head(joint.most_rows) += (Y * on_body).cwiseAbs();
  }
  return size.maxCoeff();
}

void JointRows::add_response(const JointRow& joint, const Vec6& multiplier, std::vector<Vec6>& by_body) const {
  const Vec6 negative = -multiplier;
  with_rows(joint.most_rows, [&](auto R) {
    for (int end = 0; end < joint.ends; ++end) {
      if (joint.body[end] != kWorld)
        subtract_transposed_product<R>(by_body[joint.body[end]].data(), joint.Y[end], negative.data(), 6);
    }
  });
}

Vec6 JointRows::free_acceleration(int body, const double* wrench) const {
  const Inertia& inertia = system_.bodies[body];
  Vec6 acceleration = Vec6::Zero();
  if (inertia.fixed) return acceleration;
  const EndMotion& motion = frames_[body].motion;
  const Vec6 acting = wrench ? wrench_at(wrench, stride(), body) : Vec6::Zero().eval();
  acceleration.head<3>() = system_.scene_gravity + inertia.inverse_mass * acting.head<3>();
  acceleration.tail<3>() = angular_acceleration(inertia, motion.R, motion.angular_velocity, acting.tail<3>());
  return acceleration;
}

Vec6 JointRows::acceleration_by(int body, const double* wrench) const {
  const Vec6 p = wrench_at(wrench, stride(), body);
  Vec6 acceleration;
  acceleration << system_.bodies[body].inverse_mass * p.head<3>(), frames_[body].inverse_inertia_W * p.tail<3>();
  return acceleration;
}

void JointRows::push(const double* impulse, MutableBodyColumns state) const {
  for (const int body : moved_) {
    if (system_.bodies[body].fixed) continue;
    const Vec6 change = acceleration_by(body, impulse);
    state.set_velocity(body, state.velocity(body) + change.head<3>());
    state.set_angular_velocity(body, state.angular_velocity(body) + change.tail<3>());
  }
}

void JointRows::note_velocities(BodyColumns state) {
  for (const int body : moved_) {
    frames_[body].motion.velocity = state.velocity(body);
    frames_[body].motion.angular_velocity = state.angular_velocity(body);
  }
}

void JointRows::move(const double* wrench, MutableBodyColumns state) const {
  for (const int body : moved_) {
    if (system_.bodies[body].fixed) continue;
    const Vec6 by = acceleration_by(body, wrench);
    state.set_position(body, state.position(body) + by.head<3>());
    const Quat turn = rotation_by(by.tail<3>());
    if (state.has_rotation()) state.set_rotation(body, matrix_of(turn) * state.rotation(body));
    state.set_orientation(body, (turn * state.orientation(body)).normalized());
  }
}

}  // namespace rigor::inline dynamics
