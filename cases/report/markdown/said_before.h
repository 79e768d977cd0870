// A long report says what a gate rests on, what a setting does or what a truth is independent of once, where it is met
// first: what ends a later paragraph in the same words is left out there, for an ellipsis.
#pragma once

#include <set>
#include <string>

namespace rigor {

class SaidBefore {
 public:
  // The paragraph, up to the longest end that an earlier one has too, and " …" instead of that.
  std::string shortened(const std::string& paragraph);

 private:
  std::set<std::string> ends_;
};

}  // namespace rigor
