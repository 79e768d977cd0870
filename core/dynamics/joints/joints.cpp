#include "core/dynamics/joints/joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/dynamics/kernels/kernels.h"
#include "core/engine/state_archive.h"
#include "core/scene/turn_window.h"

namespace rigor::inline dynamics {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
constexpr int kMostIterations = 50;
constexpr double kClosed = 16 * kEpsilon;  // of the longest arm: what rounding of poses leaves of a gap,
constexpr double kRounding = 1e-12;        // and where bodies are far from the origin
constexpr double kOpen = 1e-9;             // of the longest moving arm: a gap that no rounding explains
constexpr double kWellPosed = 1e-5;        // pivots above it leave eleven digits or more

// Whether a spring, or a servo that takes no shorter way, has an effort that jumps where the angle does.
bool goes_by_its_angle(const Scene& scene, std::size_t k) {
  const Joint& joint = scene.joints[k];
  if (!free_axis(joint) || !turns(joint)) return false;
  return joint.stiffness > 0 ||
         (middle_of_turn(joint) && std::any_of(scene.motors.begin(), scene.motors.end(), [k](const Motor& motor) {
            return motor.servo && motor.drives(static_cast<int>(k));
          }));
}

}  // namespace

Joints::Joints(const Scene& scene, const System& system)
    : system_(system),
      rows_(scene, system),
      factor_(rows_.make_factor()),
      rotor_(rows_.size(), 0.0),
      rotor_impulse_(rows_.size(), 0.0),
      multipliers_(rows_.size()),
      correction_(rows_.size()),
      free_(system.size()) {
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    names_.push_back(scene.joint_name(k));
    const Joint& joint = scene.joints[k];
    if (goes_by_its_angle(scene, k)) sprung_.push_back({JointCoordinate(scene, joint), k, 0});
    if (const auto* compound = std::get_if<CompoundJoint>(&joint.type)) {
      const auto& axes = compound->axes;
      const auto turn = [](const SeriesAxis& axis) { return axis.turns; };
      if (std::count_if(axes.begin(), axes.end(), turn) == kMostSeriesAxesOfAKind) {
        const auto first = std::find_if(axes.begin(), axes.end(), turn) - axes.begin();
        three_hinges_.push_back(
            {AxisSeries(axes, scene.pose(joint.a), scene.pose(joint.b)), k, static_cast<std::size_t>(first), 0});
      }
    }
  }
  for (std::size_t k = 0; k < scene.couplings.size(); ++k) names_.push_back(scene.coupling_name(k));
  total_.resize(kWrenchColumns, system.size());
  list_components();
  BodyTable start(system.size());
  set_initial_state(scene, start.columns());
  find_ranks(start.columns());
}

// Beside such a position the first angle turns quickly; behind it, it is half a turn off.
void Joints::look_for_parallel_hinges(BodyColumns state) {
  constexpr double kParallel = 1e-3;  // rad: three digits of the angles are lost
  for (ThreeHinges& hinges : three_hinges_) {
    const auto end = [&](int body) -> SeriesEnd {
      if (body == kWorld) return {};
      return {state.position(body), Vec3::Zero(), Vec3::Zero(), state.rotation(body)};
    };
    const JointRow& row = rows_.joint(hinges.joint);
    const AxisSeries::Rows at = hinges.series.at(end(row.end[0]), end(row.end[1]));
    const double x = at.coordinates[hinges.first].gap, jump = std::remainder(x - hinges.x, 2 * std::numbers::pi);
    if ((std::abs(at.sine) < kParallel || std::abs(jump) > std::numbers::pi / 2) && warning_.empty())
      warning_ =
          fmt::format("two hinges of {} have become parallel, where its angles are not unique", names_[hinges.joint]);
    hinges.x = x;
  }
}

void Joints::end_step(BodyColumns state) {
  look_for_parallel_hinges(state);
  for (SprungHinge& hinge : sprung_) {
    const double x = hinge.coordinate.at(state).x;
    if (std::abs(x - hinge.x) > std::numbers::pi && warning_.empty())
      warning_ =
          fmt::format("{} has turned by half a turn, at which the angle of its spring jumps", names_[hinge.joint]);
    hinge.x = x;
  }
}

void Joints::archive_state(StateArchive& archive) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    JointRow& joint = rows_.joint(k);
    archive(joint.row, joint.target, joint.rate);
  }
  archive(factor_, rotor_, rotor_impulse_, warning_);
  archive.each(sprung_, [&](SprungHinge& hinge) { archive(hinge.x); });
  archive.each(three_hinges_, [&](ThreeHinges& hinges) { archive(hinges.x); });
}

int Joints::rows() const {
  int sum = 0;
  for (const JointRow& joint : rows_.joints()) sum += joint.rows_in_use();
  return sum;
}

void Joints::set_coordinate(std::size_t joint, CoordinateRow row, double target, double rate) {
  JointRow& at = rows_.joint(joint);
  at.row = row, at.target = target, at.rate = rate;
  factor_.set_rows_in_use(joint, at.rows_in_use());
}

void Joints::count_rows(BodyColumns state) {
  rows_.evaluate(state);
  rows_.assemble(factor_);
  factor_.find_ranks();
}

double Joints::coordinate_effort(std::size_t joint) const {
  const JointRow& at = rows_.joint(joint);
  return at.row == CoordinateRow::none ? 0 : multipliers_[joint][at.rows] + rotor_impulse_[joint];
}

double Joints::largest_force() const { return rows_.largest_force(multipliers_, size_); }

void Joints::factorise(BodyColumns state, Rows rows) {
  rows_.evaluate(state);
  rows_.assemble(factor_);
  factor_.factorise(rows == Rows::chosen_anew);
  warn_if_singular();
}

void Joints::warn_if_singular() {
  if (factor_.smallest_pivot() > BlockCholesky::kLost || !warning_.empty()) return;
  warning_ = fmt::format("the joints are in a singular position, at {}", names_[factor_.joint_of_smallest_pivot()]);
}

void Joints::solve() {
  if (factor_.smallest_pivot() > kWellPosed) return factor_.solve(multipliers_);
  right_side_ = multipliers_;
  factor_.solve(multipliers_);
  for (int pass = 0; pass < 2; ++pass) refine();
}

// At a distance of d rad from a singular position, S has lost d^-2 roundings. The residual of J has lost only d^-1, and
// corrects the solution (the corrected semi-normal equations; Å. Björck, 1987).
void Joints::refine() {
  const double* const wrench = rows_.wrench_of(multipliers_);
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const JointRow& joint = rows_.joint(k);
    correction_[k] = right_side_[k] - rows_.response(joint, wrench);
    if (joint.carries_rotor()) correction_[k][joint.rows] += rotor_change(k, multipliers_);
  }
  factor_.solve(correction_);
  for (std::size_t k = 0; k < rows_.size(); ++k) multipliers_[k] += correction_[k];
}

const double* Joints::hold(BodyColumns state, const double* wrench, Rows rows) {
  factorise(state, rows);
  std::fill(rotor_impulse_.begin(), rotor_impulse_.end(), 0.0);
  for (const int body : rows_.moved()) free_[body] = rows_.free_acceleration(body, wrench);
  solve_for([&](const JointRow& joint) -> Vec6 { return -joint.bias - rows_.times_acceleration(joint, free_); });
  const double* const held = rows_.wrench_of(multipliers_);
  if (!wrench) return held;
  for (std::size_t c = 0; c < kWrenchColumns; ++c) {
    double* const to = total_.column(c);
    const double* const add = held + c * rows_.stride();
    std::copy_n(wrench + c * total_.stride(), system_.size(), to);
    for (const int body : rows_.moved()) to[body] += add[body];
  }
  return total_.data();
}

double Joints::coordinate_acceleration(std::size_t joint, BodyColumns state) const {
  const JointRow& row = rows_.joint(joint);
  const JointCoordinate::Value at = row.coordinate->at(state);
  double sum = at.bias;
  for (int end = 0; end < 2; ++end) {
    const int body = row.body[end];
    if (body == kWorld) continue;
    const Vec6 acceleration = free_[body] + rows_.acceleration_by(body, rows_.last_wrench());
    sum += (end == 0 ? -1 : 1) * at.force.dot(acceleration.head<3>());
    sum += (end == 0 ? at.torque_a : at.torque_b).dot(acceleration.tail<3>());
  }
  return sum;
}

// The speed that impulses along a coordinate's row take from its rotor, as a change: -l / I.
double Joints::rotor_change(std::size_t k, const std::vector<Vec6>& impulses) const {
  const JointRow& joint = rows_.joint(k);
  return -impulses[k][joint.rows] / joint.armature;
}

void Joints::note_rotors(BodyColumns state, double stagger) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const JointRow& joint = rows_.joint(k);
    if (joint.armature == 0) continue;
    const JointCoordinate::Value at = joint.coordinate->at(state);
    rotor_[k] = at.rate - stagger * at.bias;
  }
}

const double* Joints::velocity_impulse(BodyColumns state) {
  factorise(state, Rows::chosen_anew);
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const JointRow& joint = rows_.joint(k);
    const bool is_stopped = joint.armature > 0 && joint.row != CoordinateRow::none;
    rotor_impulse_[k] = is_stopped ? joint.armature * (joint.rate - rows_.times_velocity(joint)[joint.rows]) : 0;
  }
  return impulse_against_velocities();
}

const double* Joints::velocity_impulse_with_rotors(BodyColumns state) {
  factorise(state, Rows::chosen_anew);
  return impulse_against_velocities(true);
}

const double* Joints::impulse_against_velocities(bool with_rotors) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const JointRow& joint = rows_.joint(k);
    Vec6& b = multipliers_[k];
    b = -rows_.times_velocity(joint);
    if (joint.row != CoordinateRow::none) b[joint.rows] += joint.rate;
    if (joint.carries_rotor()) b[joint.rows] = with_rotors ? b[joint.rows] + rotor_[k] : 0;
  }
  solve();
  return rows_.wrench_of(multipliers_);
}

// Velocities twice: the second pass takes away what rounding left of the first.
void Joints::project(MutableBodyColumns state) {
  close_pose(state);
  factorise(state, Rows::chosen_anew);
  for (int pass = 0; pass < 2; ++pass) {
    push(impulse_against_velocities(), state);
    rows_.note_velocities(state);
  }
}

void Joints::restrict(int component, std::vector<Vec6>& change) {
  const std::vector<int>& joints = joints_of_component_[component];
  for (const int k : joints) multipliers_[k] = -rows_.times_acceleration(rows_.joint(k), change);
  factor_.solve_component(component, multipliers_);
  for (const int k : joints) rows_.add_response(rows_.joint(k), multipliers_[k], change);
}

void Joints::list_components() {
  component_of_body_.assign(system_.size(), -1);
  bodies_of_component_.resize(factor_.components());
  joints_of_component_.resize(factor_.components());
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const int component = factor_.component_of(k);
    joints_of_component_[component].push_back(static_cast<int>(k));
    for (const int body : rows_.joint(k).body) {
      if (body == kWorld || component_of_body_[body] == component) continue;
      component_of_body_[body] = component;
      bodies_of_component_[component].push_back(body);
    }
  }
}

// Newton's method, with J and S of its first iteration until they no longer serve.
void Joints::close_pose(MutableBodyColumns state) {
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    rows_.evaluate(state);
    const double gap = rows_.largest_gap();
    if (is_closed(gap, last)) break;
    rows_.assemble(factor_);
    factor_.factorise(iteration == 0);
    solve_for([](const JointRow& joint) -> Vec6 { return -joint.gap; });
    rows_.move(rows_.wrench_of(multipliers_), state);
    last = gap;
  }
  warn_of_gap(rows_.largest_gap());
}

// Also if it falls no further, or is not a number.
bool Joints::is_closed(double gap, double last, double within) const {
  return gap <= std::max(kClosed * extent_, within * size_) || (gap <= kRounding * extent_ && gap > 0.5 * last) ||
         !std::isfinite(gap);
}

void Joints::warn_of_gap(double gap) {
  if (!(gap > kOpen * size_) || !warning_.empty()) return;
  warning_ = fmt::format("the joints could not be closed: a gap of {:.3g} m (or of an angle times {:.3g} m) is left{}",
                         gap, extent_,
                         factor_.has_redundant_rows()
                             ? "; rows that repeat others at t = 0 no longer do, as where it is a singular position"
                             : "");
}

void Joints::aim_driven_coordinates(BodyColumns start, double h) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    JointRow& joint = rows_.joint(k);
    if (joint.row == CoordinateRow::driven) joint.target = joint.coordinate->at(start).x + h * joint.rate;
  }
}

// A chord method. It assumes that the impulse changes the end by h S, with J of the start at both. It starts from the
// rows and their rates at the start, which leave a gap of h³. A gap that grows leads to another pose or to none, so the
// search is then given up.
bool Joints::close(BodyColumns start, double h, const std::function<BodyColumns(const double* impulse)>& attempt,
                   double within) {
  factorise(start, Rows::chosen_anew);
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    const JointRow& joint = rows_.joint(k);
    Vec6& b = multipliers_[k];
    b = -(rows_.times_velocity(joint) + 0.5 * h * joint.bias + joint.gap / h);
    if (joint.row == CoordinateRow::driven) b[joint.rows] += joint.rate;
    if (joint.carries_rotor()) b[joint.rows] += rotor_[k];
  }
  solve();
  aim_driven_coordinates(start, h);
  total_multipliers_ = multipliers_;
  double last = std::numeric_limits<double>::infinity();
  for (int iteration = 0; iteration < kMostIterations; ++iteration) {
    aim_rotors(start, h);
    const double gap = rows_.measure_gaps(attempt(rows_.wrench_of(total_multipliers_)));
    if (is_closed(gap, last, within)) return turn_rotors(), std::isfinite(gap);
    if (gap > extent_ || gap > last) return false;
    solve_for([h](const JointRow& joint) -> Vec6 { return -joint.gap / h; });
    for (std::size_t k = 0; k < rows_.size(); ++k) total_multipliers_[k] += multipliers_[k];
    last = gap;
  }
  turn_rotors();
  return last <= kOpen * size_;
}

// A coordinate with a rotor ends where its rotor does after the impulses so far.
void Joints::aim_rotors(BodyColumns start, double h) {
  for (std::size_t k = 0; k < rows_.size(); ++k) {
    JointRow& joint = rows_.joint(k);
    if (joint.carries_rotor())
      joint.target = joint.coordinate->at(start).x + h * (rotor_[k] + rotor_change(k, total_multipliers_));
  }
}

void Joints::turn_rotors() {
  for (std::size_t k = 0; k < rows_.size(); ++k)
    if (rows_.joint(k).carries_rotor()) rotor_[k] += rotor_change(k, total_multipliers_);
}

}  // namespace rigor::inline dynamics
