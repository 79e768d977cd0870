#include "core/base/eigen_of.h"

#include <Eigen/Eigenvalues>

namespace rigor {

SymmetricEigen eigen_of(const Mat3& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(symmetric);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace rigor
