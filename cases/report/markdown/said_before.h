// Shortens long reports. The basis of a gate, the effect of a setting and the independence of a truth are explained at
// their first place. Later paragraphs replace an identical ending by an ellipsis.
#pragma once

#include <set>
#include <string>

namespace rigor::inline report {

class SaidBefore {
 public:
  // The paragraph, up to the longest end that an earlier one has too, and " …" instead of that.
  std::string shortened(const std::string& paragraph);

 private:
  std::set<std::string> ends_;
};

}  // namespace rigor::inline report
