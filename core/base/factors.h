// Linear systems solved with Eigen's factorisations. Each factorisation takes a compiler seconds, so all are compiled
// here once. Unknowns and right sides have the units of the matrix.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <Eigen/SparseCholesky>
#include <variant>

namespace rigor {

class DenseFactors {
 public:
  // P A = L U, or A = L Lᵀ in half the time.
  enum class Kind { general, positive_definite };
  void factorise(const Eigen::MatrixXd& A, Kind kind);  // keeps the space of the last one of its kind
  // Of a singular A no number of the solution may be finite, or right.
  Eigen::VectorXd solve(const Eigen::VectorXd& right_side) const;

 private:
  std::variant<Eigen::PartialPivLU<Eigen::MatrixXd>, Eigen::LLT<Eigen::MatrixXd>> factors_;
};

// A = Pᵀ L D Lᵀ P of a symmetric A.
class SymmetricFactors {
 public:
  explicit SymmetricFactors(const Eigen::MatrixXd& A);
  bool is_regular() const;  // no pivot is zero; else it solves nothing
  Eigen::VectorXd solve(const Eigen::VectorXd& right_side) const;

 private:
  Eigen::LDLT<Eigen::MatrixXd> factors_;
};

// A = L D Lᵀ of a symmetric, sparse A.
class SparseFactors {
 public:
  explicit SparseFactors(const Eigen::SparseMatrix<double>& A);
  bool is_regular() const;  // no pivot is zero; else it solves nothing
  Eigen::VectorXd solve(const Eigen::VectorXd& right_side) const;

 private:
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factors_;
};

}  // namespace rigor
