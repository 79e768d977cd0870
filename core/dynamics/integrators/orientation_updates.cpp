#include "core/dynamics/integrators/orientation_updates.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cassert>
#include <limits>

namespace rigor::inline dynamics {
namespace {

// The rotation nearest to R (its orthogonal polar factor); not a number if R is not finite.
Quat nearest_rotation(const Mat3& R) {
  if (!R.allFinite()) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    return {nan, nan, nan, nan};
  }
  const Eigen::JacobiSVD<Mat3> svd(R, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 U = svd.matrixU();
  if (U.determinant() * svd.matrixV().determinant() < 0) U.col(2) *= -1;
  return Quat(Mat3(U * svd.matrixV().transpose())).normalized();
}

void set_matrix(MutableBodyColumns state, std::size_t body, const Mat3& R) {
  state.set_rotation(body, R);
  state.set_orientation(body, nearest_rotation(R));
}

void matrix_additive(MutableBodyColumns state, std::size_t body, const Vec3& w, double dt) {
  const Mat3 R = state.rotation(body);
  set_matrix(state, body, R + dt * cross_matrix(w) * R);
}

void matrix_rodrigues(MutableBodyColumns state, std::size_t body, const Vec3& w, double dt) {
  set_matrix(state, body, matrix_of(rotation_by(dt * w)) * state.rotation(body));
}

void quaternion_additive(MutableBodyColumns state, std::size_t body, const Vec3& w, double dt) {
  const Quat q = state.orientation(body);
  const Quat rate = Quat(0, w.x(), w.y(), w.z()) * q;
  state.set_orientation(body, Quat(q.coeffs() + 0.5 * dt * rate.coeffs()).normalized());
}

void quaternion_exponential(MutableBodyColumns state, std::size_t body, const Vec3& w, double dt) {
  state.set_orientation(body, (rotation_by(dt * w) * state.orientation(body)).normalized());
}

}  // namespace

const std::vector<OrientationUpdate>& orientation_updates() {
  static const std::vector<OrientationUpdate> table = {
      {"matrix-additive", true, matrix_additive},
      {"matrix-rodrigues", true, matrix_rodrigues},
      {"quaternion-additive", false, quaternion_additive, Turn::additive},
      {"quaternion-exponential", false, quaternion_exponential, Turn::exponential},
  };
  return table;
}

const OrientationUpdate& orientation_update(const std::string& name) {
  const auto& table = orientation_updates();
  const auto row = std::find_if(table.begin(), table.end(), [&](const auto& r) { return r.name == name; });
  assert(row != table.end() && "option values are checked when the run is named");
  return *row;
}

}  // namespace rigor::inline dynamics
