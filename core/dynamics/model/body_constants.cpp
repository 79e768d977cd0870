#include "core/dynamics/model/body_constants.h"

#include "core/dynamics/model/free_rotation.h"

namespace rigor::inline dynamics {

BodyConstants::BodyConstants(const std::vector<Inertia>& bodies, const Vec3& gravity)
    : columns_(kConstantColumns, bodies.size()), size_(bodies.size()), gravity_(gravity) {
  for (std::size_t i = 0; i < size_; ++i) set_body(i, bodies[i]);
}

void BodyConstants::use_threads(int count) { thread_pool_ = count > 1 ? std::make_shared<ThreadPool>(count) : nullptr; }

void BodyConstants::set_body(std::size_t i, const Inertia& body) {
  columns_.column(kAxes)[i] = 1;
  has_fixed_ |= body.fixed;
  if (body.fixed) return;
  columns_.column(kInverseMass)[i] = body.inverse_mass;
  columns_.column(kMoves)[i] = 1;
  const Vec3 d = body.inertia_B.diagonal();
  const Vec3 gyro((d.y() - d.z()) / d.x(), (d.z() - d.x()) / d.y(), (d.x() - d.y()) / d.z());
  const FreeRotation rotation(body);
  for (int k = 0; k < 3; ++k) columns_.column(kGyro + k)[i] = gyro[k];
  for (int k = 0; k < 3; ++k) columns_.column(kAxes + 1 + k)[i] = rotation.q_BP.vec()[k];
  columns_.column(kAxes)[i] = rotation.q_BP.w();
  columns_.column(kInverseMedian)[i] = rotation.inverse_median;
  columns_.column(kExcessLow)[i] = rotation.excess_low;
  columns_.column(kExcessHigh)[i] = rotation.excess_high;
  set_symmetric(kInertia, i, body.inertia_B);
  set_symmetric(kInverseInertia, i, body.inverse_inertia_B);
  diagonal_ &= body.inertia_B.isDiagonal(0);
  round_ &= body.inertia_B.isDiagonal(0) && d.x() == d.y() && d.y() == d.z();
  principal_ &= rotation.q_BP.vec().isZero(0);
}

void BodyConstants::set_symmetric(ConstantColumn column, std::size_t i, const Mat3& m) {
  const double elements[] = {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(0, 2), m(1, 2)};
  for (int k = 0; k < 6; ++k) columns_.column(column + k)[i] = elements[k];
}

Bodies BodyConstants::all() const {
  return {.begin = 0,
          .end = size_,
          .stride = columns_.stride(),
          .constants = columns_.data(),
          .gravity = {gravity_.x(), gravity_.y(), gravity_.z()},
          .has_gravity = !gravity_.isZero(0),
          .has_fixed = has_fixed_,
          .diagonal = diagonal_,
          .principal = principal_,
          .round = round_};
}

}  // namespace rigor::inline dynamics
