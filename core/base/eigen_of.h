// Eigenvalues and eigenvectors of a symmetric matrix by Eigen's solver, which takes a compiler seconds: once, for all.
#pragma once

#include "core/base/math.h"

namespace rigor {

struct SymmetricEigen {
  Vec3 values;   // ascending, in the matrix's unit
  Mat3 vectors;  // its columns, of length 1, normal to each other; of either hand
};

SymmetricEigen eigen_of(const Mat3& symmetric);

}  // namespace rigor
