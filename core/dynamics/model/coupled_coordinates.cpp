#include "core/dynamics/model/coupled_coordinates.h"

#include <cmath>

namespace rigor::inline dynamics {

CoupledCoordinates::CoupledCoordinates(const Scene& scene, const Coupling& coupling) : offset_(coupling.offset) {
  add(scene, coupling.joint, 1);
  for (const JointTerm& term : coupling.to) add(scene, term.joint, -term.ratio);
  const Term &x = terms_[0], &y = terms_[1];
  turns_of_y_follow_ = !x.coordinate.turns() || (y.coordinate.turns() && std::abs(y.factor) < 1);
}

void CoupledCoordinates::add(const Scene& scene, int joint, double factor) {
  JointCoordinate coordinate(scene, scene.joints[static_cast<std::size_t>(joint)]);
  const int a = end(coordinate.a()), b = end(coordinate.b());
  terms_.push_back({std::move(coordinate), factor, a, b});
}

int CoupledCoordinates::end(int body) {
  for (int k = 0; k < count_; ++k)
    if (ends_[static_cast<std::size_t>(k)] == body) return k;
  ends_[static_cast<std::size_t>(count_)] = body;
  return count_++;
}

CoupledCoordinates::Row CoupledCoordinates::at(BodyColumns state) {
  Row row;
  row.force.fill(Vec3::Zero()), row.torque.fill(Vec3::Zero());
  row.bias = 0;
  const auto add = [&](int place, double factor, const Vec3& force, const Vec3& torque) {
    const auto end = static_cast<std::size_t>(place);
    row.force[end] += factor * force, row.torque[end] += factor * torque;
  };
  for (Term& term : terms_) {
    const JointCoordinate::Value at = term.coordinate.at(state);
    add(term.place_a, term.factor, -at.force, at.torque_a);
    add(term.place_b, term.factor, at.force, at.torque_b);
    row.bias += term.factor * at.bias;
    term.angle = at.x;
  }
  count_turns();
  row.gap = -offset_;
  for (const Term& term : terms_) row.gap += term.factor * term.x;
  return row;
}

void CoupledCoordinates::count_turns() {
  if (terms_.size() > 2) {
    for (Term& term : terms_) term.x = term.angle;
    return;
  }
  Term &x = terms_[0], &y = terms_[1];
  const double ratio = -y.factor;
  const auto turn = [](Term& term, double near) { term.x = term.coordinate.with_turns(term.angle, near); };
  if (turns_of_y_follow_) {
    turn(x, x.x), turn(y, (x.x - offset_) / ratio);
  } else {
    turn(y, y.x), turn(x, ratio * y.x + offset_);
  }
}

}  // namespace rigor::inline dynamics
