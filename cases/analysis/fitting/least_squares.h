// Minimises a sum of squares by the method of Levenberg and Marquardt (SIAM J. Appl. Math. 11 (1963) 431). Derivatives
// are differences. Some of the unknowns stay between 0 and 1, and some may be held.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

namespace rigor::inline analysis {

// Returns the residuals at each point; an empty vector where there is no result. All points have equally many.
using ResidualsAt = std::function<std::vector<Eigen::VectorXd>(const std::vector<Eigen::VectorXd>& points)>;

struct SquaresMinimum {
  Eigen::VectorXd at, residuals;  // the last step is one of the linear model
  Eigen::MatrixXd jacobian;       // of the residuals; possibly of a point shortly before
  double value = HUGE_VAL;        // the sum of squares; infinite without a result
  bool has_result() const { return residuals.size() > 0; }
};

class LeastSquares {
 public:
  // The first `boxed` unknowns lie between 0 and 1. One standard deviation of the noise is 1 in the residuals.
  LeastSquares(ResidualsAt residuals, long boxed, long unknowns);

  // `held`: an unknown that keeps its value; -1: none.
  SquaresMinimum minimise(const Eigen::VectorXd& start, long held = -1, int most_steps = 20);

 private:
  bool evaluate(SquaresMinimum& point) const;  // false without a result
  void differentiate(SquaresMinimum& point);
  Eigen::VectorXd step_of(const SquaresMinimum& from, double damping, long held) const;

  ResidualsAt residuals_;
  long boxed_, unknowns_;
  Eigen::VectorXd steps_;  // of the differences
};

}  // namespace rigor::inline analysis
