#include "core/dynamics/joints/ball_joints.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace rigor::inline dynamics {
namespace {

// Relative to the product of a block's diagonal before elimination. With a smaller determinant the inverse has lost six
// digits and cannot serve for corrections.
constexpr double kLeastDeterminant = 1e-10;
constexpr int kMostCorrections = 20;

std::size_t whole_blocks(std::size_t rows) { return (rows + 7) / 8 * 8; }

// S S⁻¹ = 1 of a symmetric positive matrix, by its cofactors; false if it is too near a singular one.
bool invert(const double* s, Mat3& inverse) {
  const double xx = s[0], yy = s[8], zz = s[16], xy = s[24], xz = s[32], yz = s[40], scale = s[48];
  const double of_x = yy * zz - yz * yz, of_xy = xz * yz - xy * zz, of_xz = xy * yz - xz * yy;
  const double determinant = xx * of_x + xy * of_xy + xz * of_xz;
  if (!(determinant > kLeastDeterminant * scale)) return false;
  const double f = 1 / determinant, of_yz = xy * xz - xx * yz;
  inverse << f * of_x, f * of_xy, f * of_xz,          //
      f * of_xy, f * (xx * zz - xz * xz), f * of_yz,  //
      f * of_xz, f * of_yz, f * (xx * yy - xy * xy);
  return true;
}

}  // namespace

bool BallJoints::are_all_of(const Scene& scene) {
  std::set<std::pair<int, int>> held;
  const bool are_free = scene.couplings.empty() && std::none_of(scene.motors.begin(), scene.motors.end(),
                                                                [](const Motor& m) { return !m.gives_effort(); });
  return are_free && std::all_of(scene.joints.begin(), scene.joints.end(), [&](const Joint& joint) {
           const bool is_hinge =
               std::holds_alternative<HingeJoint>(joint.type) && !joint.has_limits() && joint.armature == 0;
           return (is_hinge || std::holds_alternative<BallJoint>(joint.type)) &&
                  held.insert(std::minmax(joint.a, joint.b)).second;
         });
}

BallJoints::BallJoints(const Scene& scene, const System& system, double size, double within)
    : BallJoints(scene, system, pins_of(scene, size), size * within) {}

BallJoints::BallJoints(const Scene& scene, const System& system, const std::vector<Pin>& pins, double within)
    : system_(system),
      within_(within),
      world_(whole_blocks(system.size())),
      order_(pins.size(), coupled(pins, scene)),
      first_(order_.row_below.size(), world_),
      factor_(order_.row_below.size()),
      inverse_(order_.size()),
      solution_(order_.size()),
      end_(system.size()) {
  for (Records* records : {&poses_, &velocities_, &impulses_, &inverse_inertias_})
    records->assign(kRecord * (world_ + 1), 0.0);
  poses_[kRecord * world_ + kPoseOrientation] = 1;
  set_rows(scene, pins);
  list_couplings(scene);
  list_closings(scene, pins);
}

std::vector<BallJoints::Pin> BallJoints::pins_of(const Scene& scene, double apart) {
  std::vector<Pin> pins;
  for (const Joint& joint : scene.joints) {
    if (const auto* ball = std::get_if<BallJoint>(&joint.type)) {
      pins.push_back({joint.a, joint.b, ball->anchor});
      continue;
    }
    const auto& hinge = std::get<HingeJoint>(joint.type);
    const Vec3 axis = hinge.axis.normalized();
    pins.push_back({joint.a, joint.b, hinge.anchor});
    pins.push_back({joint.a, joint.b, hinge.anchor + apart * axis, axis, false});
  }
  return pins;
}

// The pairs of pins that share a body that can move.
std::vector<std::pair<int, int>> BallJoints::coupled(const std::vector<Pin>& pins, const Scene& scene) {
  std::vector<std::vector<int>> on_body(scene.bodies.size());
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t k = 0; k < pins.size(); ++k) {
    for (const int body : {pins[k].a, pins[k].b}) {
      if (body == kWorld || scene.bodies[body].fixed) continue;
      for (const int other : on_body[body]) pairs.emplace_back(other, k);
      on_body[body].push_back(static_cast<int>(k));
    }
  }
  return pairs;
}

void BallJoints::set_rows(const Scene& scene, const std::vector<Pin>& pins) {
  const std::size_t rows = whole_blocks(order_.size());
  by_pin_.assign(rows * kBallColumns, 0.0);
  a_.assign(rows, static_cast<std::int32_t>(world_)), b_ = a_;
  for (std::size_t p = 0; p < order_.size(); ++p) {
    const Pin& pin = pins[order_.joint[p]];
    const auto set = [&](int column, const Vec3& value) {
      for (int k = 0; k < 3; ++k) row(p)[8 * (column + k)] = value[k];
    };
    const auto set_end = [&](int body, std::int32_t& record, int column) {
      const BodyPose pose = scene.pose(body);
      set(column, matrix_of(pose.orientation).transpose() * (pin.point - pose.position));
      if (body != kWorld) record = body;
    };
    set_end(pin.a, a_[p], kPinA), set_end(pin.b, b_[p], kPinB);
    set(kAxisInA, matrix_of(scene.pose(pin.a).orientation).transpose() * pin.axis);
    has_axes_ |= !pin.closes;
  }
}

BallJoints::Couplings::Couplings(std::size_t couplings, std::size_t world) : size(couplings) {
  const std::size_t rows = whole_blocks(couplings);
  blocks.assign(rows * kCouplingColumns, 0.0);
  body.assign(rows, static_cast<std::int32_t>(world));
  row_arm.assign(rows, 0), column_arm = row_axis = column_axis = row_arm;
}

void BallJoints::Couplings::set(std::size_t u, std::int32_t of_body, const PinEnd& row, const PinEnd& column) {
  body[u] = of_body;
  row_arm[u] = row.arm, row_axis[u] = row.axis, column_arm[u] = column.arm, column_axis[u] = column.axis;
  blocks[start_of_row(u, kCouplingColumns) + 8 * kSign] = row.is_b == column.is_b ? 1 : -1;
}

BallCouplings BallJoints::Couplings::rows() {
  return {size, blocks.data(), body.data(), row_arm.data(), column_arm.data(), row_axis.data(), column_axis.data()};
}

// Blocks that are only filled in have no sign, and so begin at zero.
void BallJoints::list_couplings(const Scene& scene) {
  const auto end = [&](std::size_t p, bool is_b) {
    const auto start = static_cast<std::int32_t>(start_of_row(p, kBallColumns));
    return PinEnd{start + 8 * (is_b ? kArmOfB : kArmOfA), start + 8 * kAxis, is_b};
  };
  struct Other {
    std::int32_t body;
    PinEnd row, column;
  };
  std::vector<Other> others;
  for (std::size_t p = 0; p < order_.size(); ++p) {
    for (std::int32_t u = order_.first_below[p]; u < order_.first_below[p + 1]; ++u) {
      const std::size_t below = order_.row_below[u];
      bool has_first = false;
      for (const auto& [at_row, at_column] : {std::pair(false, false), {false, true}, {true, false}, {true, true}}) {
        const std::int32_t body = (at_row ? b_ : a_)[below];
        if (body != (at_column ? b_ : a_)[p] || body == static_cast<std::int32_t>(world_)) continue;
        if (scene.bodies[body].fixed) continue;
        if (!has_first) {
          first_.set(u, body, end(below, at_row), end(p, at_column));
        } else {
          others.push_back({body, end(below, at_row), end(p, at_column)});
          add_to_.push_back(u);
        }
        has_first = true;
      }
    }
  }
  other_ = Couplings(others.size(), world_);
  for (std::size_t k = 0; k < others.size(); ++k) other_.set(k, others[k].body, others[k].row, others[k].column);
}

// Starts from immovable bodies, or from the heaviest body of each component, and goes outwards.
void BallJoints::list_closings(const Scene& scene, const std::vector<Pin>& pins) {
  const auto bodies = static_cast<int>(scene.bodies.size());
  const auto node = [&](int body) { return body == kWorld || scene.bodies[body].fixed ? bodies : body; };
  std::vector<std::vector<std::size_t>> pins_of(scene.bodies.size() + 1);
  for (std::size_t p = 0; p < order_.size(); ++p) {
    const Pin& pin = pins[order_.joint[p]];
    if (pin.closes) pins_of[node(pin.a)].push_back(p), pins_of[node(pin.b)].push_back(p);
  }
  std::vector<int> roots(scene.bodies.size());
  std::iota(roots.begin(), roots.end(), 0);
  std::stable_sort(roots.begin(), roots.end(),
                   [&](int i, int k) { return scene.bodies[i].mass > scene.bodies[k].mass; });
  roots.insert(roots.begin(), bodies);
  std::vector<bool> reached(roots.size());
  for (const int root : roots) {
    std::vector<int> front;
    if (!reached[root]) reached[root] = true, front.push_back(root);
    while (!front.empty()) {
      const int from = front.back();
      front.pop_back();
      for (const std::size_t p : pins_of[from]) {
        const Pin& pin = pins[order_.joint[p]];
        const bool is_forward = node(pin.a) == from;
        const int stays = is_forward ? pin.a : pin.b, moves = is_forward ? pin.b : pin.a;
        if (reached[node(moves)]) continue;
        closings_.push_back({p, stays, moves, is_forward ? 1.0 : -1.0});
        reached[moves] = true, front.push_back(moves);
      }
    }
  }
  if (closings_.size() < scene.joints.size()) closings_.clear();  // some joint closes a loop
}

BallRows BallJoints::rows() {
  return {order_.size(), has_axes_,     by_pin_.data(), a_.data(),
          b_.data(),     first_.rows(), other_.rows(),  inverse_inertias_.data()};
}

bool BallJoints::drift(MutableBodyColumns state, double h, Turn turn) {
  const Bodies bodies = system_.constants.all();
  const BallRows balls = rows();
  kernels().gather_inverse_inertias(bodies, state.column(0), inverse_inertias_.data());
  kernels().gather_velocities(bodies, state.column(0), velocities_.data());
  ball_kernels().gather_poses(bodies, state.column(0), poses_.data());
  ball_kernels().prepare(balls, poses_.data(), velocities_.data(), h);
  ball_kernels().assemble(balls);
  add_other_couplings();
  if (!factorise()) return false;
  std::fill(impulses_.begin(), impulses_.end(), 0.0);
  for (int corrections = 0; corrections < kMostCorrections; ++corrections) {
    solve();
    add_impulses();
    ball_kernels().push_and_drift(bodies, state.column(0), impulses_.data(), inverse_inertias_.data(), turn, h,
                                  end_.columns().column(0), poses_.data());
    if (ball_kernels().measure(balls, poses_.data(), h) <= within_) {
      close(end_.columns());
      copy_columns(end_.columns(), state);
      return true;
    }
  }
  return false;
}

void BallJoints::add_other_couplings() {
  for (std::size_t k = 0; k < add_to_.size(); ++k) {
    const double* const from = other_.blocks.data() + start_of_row(k, kCouplingColumns) + 8 * kBlock;
    double* const to = block_at(add_to_[k]);
    for (int i = 0; i < 9; ++i) to[8 * i] += from[8 * i];
  }
}

bool BallJoints::factorise() {
  for (std::size_t p = 0; p < order_.size(); ++p) {
    if (!invert(row(p) + 8 * kDiagonal, inverse_[p])) return false;
    const std::int32_t first = order_.first_below[p], last = order_.first_below[p + 1];
    for (std::int32_t u = first; u < last; ++u) factor_[u] = block(u).lazyProduct(inverse_[p]);
    std::size_t product = order_.first_target[p];
    for (std::int32_t u = first; u < last; ++u) {
      const Mat3 column = block(u);
      for (std::int32_t l = u; l < last; ++l) subtract(factor_[l], column, order_.target[product++]);
    }
  }
  return true;
}

Mat3 BallJoints::block(std::int32_t u) {
  const double* const at = block_at(u);
  Mat3 B;
  for (int k = 0; k < 9; ++k) B.data()[k] = at[8 * k];
  return B;
}

// F Bᵀ from the block `target`, or from the diagonal block of ~target.
void BallJoints::subtract(const Mat3& F, const Mat3& B, std::int32_t target) {
  const auto product = [&](int i, int k) { return F(i, 0) * B(k, 0) + F(i, 1) * B(k, 1) + F(i, 2) * B(k, 2); };
  if (target < 0) {
    double* const D = row(~target) + 8 * kDiagonal;
    D[0] -= product(0, 0), D[8] -= product(1, 1), D[16] -= product(2, 2);
    D[24] -= product(0, 1), D[32] -= product(0, 2), D[40] -= product(1, 2);
    return;
  }
  double* const to = block_at(target);
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) to[8 * (3 * k + i)] -= product(i, k);
  }
}

void BallJoints::solve() {
  const std::size_t size = order_.size();
  for (std::size_t p = 0; p < size; ++p) {
    const double* const right_side = row(p) + 8 * kRightSide;
    solution_[p] = {right_side[0], right_side[8], right_side[16]};
  }
  for (std::size_t p = 0; p < size; ++p) {
    const Vec3 at = solution_[p];
    for (std::int32_t u = order_.first_below[p]; u < order_.first_below[p + 1]; ++u)
      solution_[order_.row_below[u]] -= factor_[u].lazyProduct(at);
  }
  for (std::size_t p = size; p-- > 0;) {
    Vec3 at = inverse_[p].lazyProduct(solution_[p]);
    for (std::int32_t u = order_.first_below[p]; u < order_.first_below[p + 1]; ++u)
      at -= factor_[u].transpose().lazyProduct(solution_[order_.row_below[u]]);
    solution_[p] = at;
  }
}

void BallJoints::add_impulses() {
  const auto add = [&](std::int32_t body, const Vec3& impulse, const double* arm) {
    double* const to = impulses_.data() + kRecord * static_cast<std::size_t>(body);
    const Vec3 moment = Vec3(arm[0], arm[8], arm[16]).cross(impulse);
    for (int k = 0; k < 3; ++k) to[k] += impulse[k], to[3 + k] += moment[k];
  };
  for (std::size_t p = 0; p < order_.size(); ++p) {
    add(b_[p], solution_[p], row(p) + 8 * kArmOfB);
    add(a_[p], -solution_[p], row(p) + 8 * kArmOfA);
  }
}

void BallJoints::close(MutableBodyColumns state) const {
  for (const Closing& closing : closings_) {
    const double* const reach = by_pin_.data() + start_of_row(closing.row, kBallColumns) + 8 * kReach;
    const Vec3 from = closing.stays == kWorld ? Vec3(0, 0, 0) : state.position(closing.stays);
    state.set_position(closing.moves, from + closing.sign * Vec3(reach[0], reach[8], reach[16]));
  }
}

}  // namespace rigor::inline dynamics
