// Decompositions of Eigen that take a compiler seconds each: compiled once, for all. See factors.h for equations with
// one solution.
#pragma once

#include "core/base/math.h"

namespace rigor {

struct SymmetricEigen {
  Vec3 values;   // ascending, in the matrix's unit
  Mat3 vectors;  // its columns, of length 1, normal to each other; of either hand
};

SymmetricEigen eigen_of(const Mat3& symmetric);

struct DenseEigen {
  Eigen::VectorXd values;   // ascending
  Eigen::MatrixXd vectors;  // its columns, orthonormal
};

DenseEigen dense_eigen_of(const Eigen::MatrixXd& symmetric);

// The X with the least |A X - B|, column by column, by Householder's QR with pivots. X is 0 where A has no rank.
Eigen::MatrixXd least_squares(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

// An orthonormal basis of the columns of A, as columns. A pivot counts if it exceeds this share of the largest.
Eigen::MatrixXd basis_of(const Eigen::MatrixXd& A, double share);

}  // namespace rigor
