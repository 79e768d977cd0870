#include "adapters/siconos/siconos_slope.h"

namespace rigor::inline adapters {

void load_slopes(const Loads& loads, BodyColumns state, const Wrenches& wrenches, double t, double reach,
                 std::vector<Mat6>& out) {
  out.assign(state.size(), Mat6::Zero());
  visit_load_jacobian(loads, state, t, 0, [&](const WrenchDerivative& d) {
    if (d.row == d.column) out[d.row] += reach * d.by_pose + d.by_velocity;
  });
  for (std::size_t i = 0; i < out.size(); ++i) {
    const Mat3 R = matrix_of(state.orientation(i));
    out[i].rightCols<3>() = (out[i].rightCols<3>() * R).eval();
    out[i].bottomRows<3>() = (R.transpose() * out[i].bottomRows<3>()).eval();
    out[i].bottomRightCorner<3, 3>() += reach * cross_matrix(R.transpose() * wrenches[i].torque);
  }
}

}  // namespace rigor::inline adapters
