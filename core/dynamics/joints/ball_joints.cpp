#include "core/dynamics/joints/ball_joints.h"

#include <algorithm>
#include <numeric>
#include <set>

namespace rigor {
namespace {

// Of the product of a block's diagonal before elimination: a smaller determinant has lost six digits of its inverse,
// which then no longer serves for corrections.
constexpr double kLeastDeterminant = 1e-10;
constexpr int kMostCorrections = 20;

std::size_t whole_blocks(std::size_t rows) { return (rows + 7) / 8 * 8; }

std::vector<std::pair<int, int>> pairs_that_share_a_body(const Scene& scene) {
  std::vector<std::vector<int>> on_body(scene.bodies.size());
  std::vector<std::pair<int, int>> pairs;
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    for (const int body : {scene.joints[k].a, scene.joints[k].b}) {
      if (body == kWorld || scene.bodies[body].fixed) continue;
      for (const int other : on_body[body]) pairs.emplace_back(other, k);
      on_body[body].push_back(static_cast<int>(k));
    }
  }
  return pairs;
}

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
  return std::all_of(scene.joints.begin(), scene.joints.end(), [&](const Joint& joint) {
    return std::holds_alternative<BallJoint>(joint.type) && held.insert(std::minmax(joint.a, joint.b)).second;
  });
}

BallJoints::BallJoints(const Scene& scene, const System& system, double within)
    : system_(system),
      within_(within),
      order_(scene.joints.size(), pairs_that_share_a_body(scene)),
      world_(whole_blocks(system.size())),
      factor_(order_.row_below.size()),
      inverse_(order_.size()),
      solution_(order_.size()),
      end_(system.size()) {
  const std::size_t rows = whole_blocks(order_.size());
  by_joint_.assign(rows * kBallColumns, 0.0);
  a_.assign(rows, static_cast<std::int32_t>(world_)), b_ = a_;
  for (std::size_t p = 0; p < order_.size(); ++p) {
    const Joint& joint = scene.joints[order_.joint[p]];
    const Vec3& anchor = std::get<BallJoint>(joint.type).anchor;
    const auto set_end = [&](int body, std::int32_t& record, int column) {
      const BodyPose pose = scene.pose(body);
      const Vec3 pin = matrix_of(pose.orientation).transpose() * (anchor - pose.position);
      for (int k = 0; k < 3; ++k) row(p)[8 * (column + k)] = pin[k];
      if (body != kWorld) record = body;
    };
    set_end(joint.a, a_[p], kPinA), set_end(joint.b, b_[p], kPinB);
  }
  for (Records* records : {&poses_, &velocities_, &impulses_, &inverse_inertias_})
    records->assign(kRecord * (world_ + 1), 0.0);
  poses_[kRecord * world_ + kPoseOrientation] = 1;
  list_couplings(scene);
  list_closings(scene);
}

// Blocks that are only filled in have no sign, and so begin at zero.
void BallJoints::list_couplings(const Scene& scene) {
  const std::size_t rows = whole_blocks(order_.row_below.size());
  by_coupling_.assign(rows * kCouplingColumns, 0.0);
  body_.assign(rows, static_cast<std::int32_t>(world_)), row_arm_.assign(rows, 0), column_arm_ = row_arm_;
  const auto arm = [&](std::size_t p, bool at_b) {
    return static_cast<std::int32_t>(start_of_row(p, kBallColumns)) + 8 * (at_b ? kArmOfB : kArmOfA);
  };
  for (std::size_t p = 0; p < order_.size(); ++p) {
    for (std::int32_t u = order_.first_below[p]; u < order_.first_below[p + 1]; ++u) {
      const std::size_t below = order_.row_below[u];
      for (const auto& [at_row, at_column] : {std::pair(false, false), {false, true}, {true, false}, {true, true}}) {
        const std::int32_t body = (at_row ? b_ : a_)[below];
        if (body != (at_column ? b_ : a_)[p] || body == static_cast<std::int32_t>(world_)) continue;
        if (scene.bodies[body].fixed) continue;
        body_[u] = body, row_arm_[u] = arm(below, at_row), column_arm_[u] = arm(p, at_column);
        by_coupling_[start_of_row(u, kCouplingColumns) + 8 * kSign] = at_row == at_column ? 1 : -1;
      }
    }
  }
}

// From what does not move, else from each component's heaviest body, outwards.
void BallJoints::list_closings(const Scene& scene) {
  const auto bodies = static_cast<int>(scene.bodies.size());
  const auto node = [&](int body) { return body == kWorld || scene.bodies[body].fixed ? bodies : body; };
  std::vector<std::vector<std::size_t>> joints_of(scene.bodies.size() + 1);
  for (std::size_t p = 0; p < order_.size(); ++p) {
    const Joint& joint = scene.joints[order_.joint[p]];
    joints_of[node(joint.a)].push_back(p), joints_of[node(joint.b)].push_back(p);
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
      for (const std::size_t p : joints_of[from]) {
        const Joint& joint = scene.joints[order_.joint[p]];
        const bool is_forward = node(joint.a) == from;
        const int stays = is_forward ? joint.a : joint.b, moves = is_forward ? joint.b : joint.a;
        if (reached[node(moves)]) continue;
        closings_.push_back({p, stays, moves, is_forward ? 1.0 : -1.0});
        reached[moves] = true, front.push_back(moves);
      }
    }
  }
  if (closings_.size() < order_.size()) closings_.clear();  // some joint closes a loop
}

BallRows BallJoints::rows() {
  return {order_.size(), order_.row_below.size(), by_joint_.data(),   by_coupling_.data(),     a_.data(), b_.data(),
          body_.data(),  row_arm_.data(),         column_arm_.data(), inverse_inertias_.data()};
}

bool BallJoints::drift(MutableBodyColumns state, double h, Turn turn) {
  const Bodies bodies = system_.constants.all();
  const BallRows balls = rows();
  kernels().gather_inverse_inertias(bodies, state.column(0), inverse_inertias_.data());
  kernels().gather_velocities(bodies, state.column(0), velocities_.data());
  ball_kernels().gather_poses(bodies, state.column(0), poses_.data());
  ball_kernels().prepare(balls, poses_.data(), velocities_.data(), h);
  ball_kernels().assemble(balls);
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

Mat3 BallJoints::block(std::int32_t u) const {
  const double* const at = by_coupling_.data() + start_of_row(u, kCouplingColumns);
  Mat3 B;
  for (int k = 0; k < 9; ++k) B.data()[k] = at[8 * (kBlock + k)];
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
  double* const to = by_coupling_.data() + start_of_row(target, kCouplingColumns) + 8 * kBlock;
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
    const double* const reach = by_joint_.data() + start_of_row(closing.row, kBallColumns) + 8 * kReach;
    const Vec3 from = closing.stays == kWorld ? Vec3(0, 0, 0) : state.position(closing.stays);
    state.set_position(closing.moves, from + closing.sign * Vec3(reach[0], reach[8], reach[16]));
  }
}

}  // namespace rigor
