// Residuals of a few recorded trials as functions of the fitted values and of each trial's start. The recorded start
// has noise, so it is an unknown like the values, and all samples together determine it.
#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <vector>

#include "cases/analysis/fitting/fit_probe.h"
#include "cases/analysis/fitting/least_squares.h"

namespace rigor::inline analysis {

class StartedRuns {
 public:
  StartedRuns(FitProbe& probe, FitTrials trials, std::size_t values);

  // Fits the starts along with the values, which begin here. Returns the values; nothing without a result.
  std::optional<BoxPoint> fit_starts(const BoxPoint& from);
  // Derivatives of the residuals by the starts' unknowns, where they were fitted.
  const Eigen::MatrixXd& by_starts() const { return by_starts_; }
  const Eigen::MatrixXd& by_starts_error() const { return by_starts_error_; }  // half the difference of both sides
  // Runs the fitted starts. Returns gaps in standard deviations of the noise, all positions, then all rotations. Empty
  // where a run has no result.
  std::vector<Eigen::VectorXd> residuals(const std::vector<Eigen::VectorXd>& values);
  std::vector<int> kinds() const;  // of each residual; 0: a position, 1: a rotation

 private:
  std::vector<Eigen::VectorXd> residuals_from(const std::vector<Eigen::VectorXd>& unknowns);
  void differentiate_by_starts(const SquaresMinimum& at);
  StartedTrial run_of(const Eigen::VectorXd& unknowns, std::size_t trial) const;

  FitProbe& probe_;
  FitTrials trials_;
  std::size_t values_;
  std::vector<long> first_;  // of each trial's unknowns, and of one behind the last
  Eigen::VectorXd starts_;   // as fitted
  Eigen::MatrixXd by_starts_, by_starts_error_;
  std::size_t positions_ = 0;  // residuals
  // The last batch, by trial and unknowns. A difference along one unknown changes one trial's start at most.
  std::map<std::vector<double>, TrialResiduals> kept_;
};

}  // namespace rigor::inline analysis
