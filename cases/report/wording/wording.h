// Numbers, lists of names and what is said of them, for tables and sentences.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace rigor {

// Two or three significant digits: 0.0312, 1.3e-05, 490.
std::string rounded(double value);

// At most `width` bytes, cut between characters.
std::string shortened(std::string text, std::size_t width);

// Names in a sentence, the first few of them.
std::string listed_names(const std::vector<std::string>& names, std::size_t most);

// "a, b in 2 of 3; c in 1 of 3": those that the same is said of stand together, in the order they came.
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
  std::vector<std::pair<std::string, std::string>> said_;  // what, of whom
};

}  // namespace rigor
