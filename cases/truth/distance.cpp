#include "cases/truth/distance.h"

#include <cmath>

namespace rigor::inline truth {

double distance_between(BodyColumns a, BodyColumns b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (const double apart :
         {(a.position(i) - b.position(i)).norm(), angle_between(a.orientation(i), b.orientation(i))}) {
      if (!(apart <= largest)) largest = std::isfinite(apart) ? apart : HUGE_VAL;
    }
  }
  return largest;
}

}  // namespace rigor::inline truth
