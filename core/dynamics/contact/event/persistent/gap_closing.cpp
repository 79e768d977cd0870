#include "core/dynamics/contact/event/persistent/gap_closing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace rigor::inline dynamics {
namespace {

constexpr double kUnbounded = std::numeric_limits<double>::infinity();
// In the scene's units of gaps.
constexpr double kClosed = 1e-13;   // some roundings of a position
constexpr double kTouching = 5e-3;  // a point that drifted further than this is no longer in contact
constexpr int kMostMoves = 20, kMostSweeps = 200;
constexpr std::size_t kMostTogether = 2000;  // points: a second or two of the projection's time
constexpr double kDeep = 0.1;                // of the smaller inradius: crowded steps leave up to 0.03 for a while

void move(MutableBodyColumns state, std::size_t i, const PoseStep& motion) {
  state.set_position(i, state.position(i) + motion.head<3>());
  const Quat rotation = rotation_by(motion.tail<3>());
  state.set_orientation(i, (rotation * state.orientation(i)).normalized());
  if (state.has_rotation()) state.set_rotation(i, rotation.toRotationMatrix() * state.rotation(i));
}

}  // namespace

bool GapClosing::close(MutableBodyColumns state, const std::vector<std::pair<int, int>>& pairs,
                       std::span<const PersistentPoint> points) {
  double before = kUnbounded;
  bool is_one_by_one = false;
  for (int k = 0, most = kMostMoves; k < most; ++k) {
    open_.clear(), targets_.clear();
    contact_points_.find(state, pairs, kTouching, open_);
    deepest_ = ContactPoint();
    double widest = 0;
    for (const ContactPoint& contact : open_) {
      if (contact.gap < deepest_.gap && !contact.is_limit()) deepest_ = contact;
      const bool is_carrying = std::any_of(points.begin(), points.end(), [&](const PersistentPoint& point) {
        return point.contact.same_place(contact) && point.force.x() > 0;
      });
      if (!(contact.gap < 0 || is_carrying)) continue;
      widest = std::max(widest, std::abs(contact.gap) / contact_points_.scales().gap_unit(contact.cone.is_couple));
      targets_.push_back(target_of(contact.cone, 0, -contact.gap, is_carrying));
    }
    if (!(widest > kClosed)) return k > 0;
    const bool has_stalled = widest > 0.5 * before;
    before = widest;
    if (!is_one_by_one && (targets_.size() > kMostTogether || (has_stalled && jam())))
      is_one_by_one = true, most = k + kMostSweeps;
    if (is_one_by_one) {
      part_one_by_one(state);
      if (joints_) joints_->project(state);
      continue;
    }
    if (has_stalled) return k > 0;  // by rounding
    const std::vector<PoseStep>& motion = projection_.project(state, targets_);
    for (std::size_t i = 0; i < motion.size(); ++i) {
      if (!motion[i].isZero(0)) move(state, i, motion[i]);
    }
    if (joints_) joints_->project(state);
  }
  return true;
}

const ContactPoint* GapClosing::jam() const {
  if (!(deepest_.gap < 0)) return nullptr;
  const auto& colliders = contact_points_.colliders();
  const double size = std::min(colliders[deepest_.a].inradius, colliders[deepest_.b].inradius);
  return deepest_.gap < -kDeep * size ? &deepest_ : nullptr;
}

// If there are too many points, or the projection fails: separates each two bodies by their remaining overlap, without
// rotating them.
void GapClosing::part_one_by_one(MutableBodyColumns state) {
  moved_.assign(state.size(), Vec3::Zero());
  for (const ContactPoint& contact : open_) {
    if (contact.is_limit()) continue;
    const int a = contact.cone.a, b = contact.cone.b;
    const Vec3 n = contact.cone.frame.col(0);
    const double left = -contact.gap - n.dot(moved_[a] - moved_[b]);
    if (!(left > 0)) continue;
    const double of_a = system_.bodies[a].inverse_mass, of_b = system_.bodies[b].inverse_mass;
    moved_[a] += left * of_a / (of_a + of_b) * n;
    moved_[b] -= left * of_b / (of_a + of_b) * n;
  }
  for (std::size_t i = 0; i < state.size(); ++i) state.set_position(i, state.position(i) + moved_[i]);
}

}  // namespace rigor::inline dynamics
