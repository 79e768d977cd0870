// What a setting has to keep: "1mm", "1mrad", "2% energy", "penetration=0.001".
#pragma once

#include <string>

namespace rigor {

struct Bound {
  std::string metric;  // a row of metrics.cpp, of which less is better
  double most = 0;     // in the metric's unit
  std::string text;    // as it was given
};

// Throws InputError for a text that is none.
Bound parse_bound(const std::string& text);

}  // namespace rigor
