// Intervals of fitted values from one motion, or from a few: the profile likelihood. A value is fixed beside the best
// one, and all other unknowns are fitted again. The 95 % interval ends where twice the logarithm of the likelihood has
// fallen by 3.84 (Wilks, Annals of Mathematical Statistics 9 (1938) 60; Venzon, Moolgavkar, Applied Statistics 37
// (1988) 87).
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/fitting/least_squares.h"

namespace rigor::inline analysis {

struct ProfileInput {
  ResidualsAt residuals;                // of values from 0 to 1, in standard deviations of the noise
  std::vector<Eigen::VectorXd> starts;  // where to search
  // Derivatives of the residuals by further unknowns, which follow the values as far as a linear model tells.
  Eigen::MatrixXd others;
  Eigen::MatrixXd others_error;  // of these derivatives, as large as they are; half the difference of both sides
  // The kind of each residual, from 0 on. Residuals of one kind stand in rows of three, and rows in the order of time.
  std::vector<int> kinds;
  // The noise is only roughly known: for each kind, what is left at the best point says how large it is.
  bool is_noise_estimated = false;
};

struct ProfileAxis {
  double low = 0, high = 1;                        // of the 95 % interval
  bool is_low_open = false, is_high_open = false;  // the likelihood does not fall so far up to the end of the range
};

struct Profile {
  Eigen::VectorXd best;
  std::vector<ProfileAxis> axes;                  // of the values
  std::vector<std::vector<double>> correlations;  // of the values
  // The standard deviation of what is left, in that of the noise, of each kind; 1 where the noise explains it.
  std::vector<double> excess;
  double wait = 1;      // residuals in a row that tell as much as one; 1 where they are independent
  bool is_told = true;  // false: hardly more residuals than unknowns, so there are no axes
};

// Throws InputError if no start has a result.
Profile profile_of(const ProfileInput& input);

}  // namespace rigor::inline analysis
