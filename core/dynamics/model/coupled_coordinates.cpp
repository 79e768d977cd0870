#include "core/dynamics/model/coupled_coordinates.h"

#include <cmath>

namespace rigor {

CoupledCoordinates::CoupledCoordinates(const Scene& scene, const Coupling& coupling)
    : x_(scene, scene.joints[static_cast<std::size_t>(coupling.joint)]),
      y_(scene, scene.joints[static_cast<std::size_t>(coupling.to)]),
      ratio_(coupling.ratio),
      offset_(coupling.offset),
      turns_of_y_follow_(!x_.turns() || (y_.turns() && std::abs(ratio_) < 1)),
      place_{end(x_.a()), end(x_.b()), end(y_.a()), end(y_.b())} {}

int CoupledCoordinates::end(int body) {
  for (int k = 0; k < count_; ++k)
    if (ends_[static_cast<std::size_t>(k)] == body) return k;
  ends_[static_cast<std::size_t>(count_)] = body;
  return count_++;
}

CoupledCoordinates::Row CoupledCoordinates::at(BodyColumns state) {
  const JointCoordinate::Value x = x_.at(state), y = y_.at(state);
  count_turns(x.x, y.x);
  Row row;
  row.force.fill(Vec3::Zero()), row.torque.fill(Vec3::Zero());
  row.gap = last_x_ - ratio_ * last_y_ - offset_;
  row.bias = x.bias - ratio_ * y.bias;
  const auto add = [&](int place, double factor, const Vec3& force, const Vec3& torque) {
    const auto end = static_cast<std::size_t>(place_[place]);
    row.force[end] += factor * force, row.torque[end] += factor * torque;
  };
  add(0, 1, -x.force, x.torque_a), add(1, 1, x.force, x.torque_b);
  add(2, -ratio_, -y.force, y.torque_a), add(3, -ratio_, y.force, y.torque_b);
  return row;
}

void CoupledCoordinates::count_turns(double x, double y) {
  if (turns_of_y_follow_) {
    last_x_ = x_.with_turns(x, last_x_), last_y_ = y_.with_turns(y, (last_x_ - offset_) / ratio_);
  } else {
    last_y_ = y_.with_turns(y, last_y_), last_x_ = x_.with_turns(x, ratio_ * last_y_ + offset_);
  }
}

}  // namespace rigor
