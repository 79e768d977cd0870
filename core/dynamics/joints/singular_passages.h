// Finds when a mechanism passes a singular position, in which rows repeat others and another motion branches off.
// Examples are an upright slider-crank of equal lengths and a four-bar that folds flat. At a distance of d rad the
// smallest pivot of S (block_cholesky.h) is proportional to d². A step hardly ever ends exactly in the position. A
// passage is therefore where a parabola through the pivots of three instants falls to almost zero.
#pragma once

#include <string>
#include <vector>

namespace rigor::inline dynamics {

class SingularPassages {
 public:
  // The pivot of the last factorisation at t [s], later than the last time.
  void note(double t, double pivot);
  // An impact: the motion afterwards does not continue the motion before.
  void interrupt() { known_ = 0; }
  const std::vector<double>& times() const { return times_; }  // s, of the first passages
  std::string text() const;                                    // "at 0.2146 s, 0.985 s"; empty if there are none

  template <typename Archive>
  void archive_state(Archive& archive) {
    archive(before_.t, before_.pivot, last_.t, last_.pivot, known_, times_, count_);
  }

 private:
  struct Instant {
    double t = 0, pivot = 1;
  };
  Instant before_, last_;
  int known_ = 0;  // of the two
  std::vector<double> times_;
  long count_ = 0;
};

}  // namespace rigor::inline dynamics
