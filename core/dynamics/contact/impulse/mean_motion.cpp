#include "core/dynamics/contact/impulse/mean_motion.h"

namespace rigor::inline dynamics {

void displace(std::size_t body, const Vec3& distance, const Vec3& angle, MutableBodyColumns state) {
  state.set_position(body, state.position(body) + distance);
  const Quat turn = rotation_by(angle);
  if (state.has_rotation()) state.set_rotation(body, matrix_of(turn) * state.rotation(body));
  state.set_orientation(body, (turn * state.orientation(body)).normalized());
}

void MeanMotion::begin(BodyColumns state) {
  if (!is_needed_) return;
  changes_.resize(state.size());
  for (std::size_t i = 0; i < state.size(); ++i) changes_[i] = {-state.velocity(i), -state.angular_velocity(i)};
}

void MeanMotion::end(BodyColumns state) {
  if (!is_needed_) return;
  for (std::size_t i = 0; i < state.size(); ++i)
    changes_[i].v += state.velocity(i), changes_[i].w += state.angular_velocity(i);
}

void MeanMotion::apply(std::size_t body, double h, MutableBodyColumns state) const {
  if (is_needed_) displace(body, h * changes_[body].v, h * changes_[body].w, state);
}

}  // namespace rigor::inline dynamics
