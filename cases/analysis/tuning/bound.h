// The bound that a setting must keep: "1mm", "1mrad", "2% energy", "penetration=0.001".
#pragma once

#include <string>

namespace rigor::inline analysis {

struct Bound {
  std::string metric;  // a row of metrics.cpp whose smaller values are better
  double most = 0;     // in the metric's unit
  std::string text;    // as it was given
};

// Throws InputError for a text that is no bound.
Bound parse_bound(const std::string& text);

}  // namespace rigor::inline analysis
