// Numbers, names and lists, for tables and sentences.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace rigor::inline report {

// Two or three significant digits: 0.0312, 1.3e-05, 490.
std::string rounded(double value);

// Two significant digits, without an exponent between 1e-3 and 1e5: "0.66", "1200", "2.3e-5".
std::string two_digits(double value);

std::string three_digits(double value);  // likewise

// Two significant digits and a unit that people use: "31 mm", "4.2 ms", "0.46 rad", "8e-5 kg m²". Metres, seconds and
// radians get a prefix. Without a unit: the digits alone.
std::string quantity_text(double value, const std::string& unit);

std::string percent_text(double share);  // "3.4 %"

// At most `width` bytes, cut between characters.
std::string shortened(std::string text, std::size_t width);

// The first `most` names, and how many more there are.
std::string listed_names(const std::vector<std::string>& names, std::size_t most);

// "a, b in 2 of 3; c in 1 of 3": names with the same text share it, in the order in which they came.
class GroupedNames {
 public:
  void add(const std::string& name, const std::string& what) {
    const auto said = std::find_if(said_.begin(), said_.end(), [&](const auto& s) { return s.first == what; });
    said == said_.end() ? said_.push_back({what, name}) : void(said->second += ", " + name);
  }
  void add(const GroupedNames& others) { said_.insert(said_.end(), others.said_.begin(), others.said_.end()); }
  bool empty() const { return said_.empty(); }
  std::string text() const {
    std::string text;
    for (const auto& [what, names] : said_) text += (text.empty() ? "" : "; ") + names + what;
    return text;
  }

 private:
  std::vector<std::pair<std::string, std::string>> said_;  // the text, and its names
};

}  // namespace rigor::inline report
