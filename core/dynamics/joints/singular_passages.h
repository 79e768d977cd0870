// When a mechanism passes a singular position, in which rows come to repeat others and another motion branches off: a
// slider-crank of equal lengths upright, a four-bar that folds flat. At a distance of d rad from one the smallest pivot
// of S (block_cholesky.h) is proportional to d², and a step of a run hardly ever ends in the position itself: it is
// where a parabola through three instants' pivots comes down to next to nothing.
#pragma once

#include <string>
#include <vector>

namespace rigor {

class SingularPassages {
 public:
  // The pivot of the last factorisation at t [s], later than the last time.
  void note(double t, double pivot);
  // An impact: what follows is no continuation of what was.
  void interrupt() { known_ = 0; }
  const std::vector<double>& times() const { return times_; }  // s, of the first of them
  std::string text() const;                                    // "at 0.2146 s, 0.985 s"; empty where there is none

 private:
  struct Instant {
    double t = 0, pivot = 1;
  };
  Instant before_, last_;
  int known_ = 0;  // of the two
  std::vector<double> times_;
  long count_ = 0;
};

}  // namespace rigor
