#include "cases/report/markdown/said_before.h"

#include <vector>

namespace rigor::inline report {
namespace {

constexpr std::size_t kWorthIt = 40;  // bytes: below that an ellipsis costs more than it saves

// Where a part of a paragraph begins that may stand for itself: after a full stop, a colon, a semicolon, and at a
// parenthesis.
std::vector<std::size_t> starts_of_parts(const std::string& paragraph) {
  std::vector<std::size_t> starts;
  for (std::size_t at = 2; at + kWorthIt < paragraph.size(); ++at) {
    const bool is_after_stop = paragraph[at - 1] == ' ' && std::string(".:;").find(paragraph[at - 2]) < 3;
    if (is_after_stop || (paragraph[at] == '(' && paragraph[at - 1] == ' ')) starts.push_back(at);
  }
  return starts;
}

}  // namespace

std::string SaidBefore::shortened(const std::string& paragraph) {
  for (const std::size_t start : starts_of_parts(paragraph)) {
    if (!ends_.insert(paragraph.substr(start)).second) return paragraph.substr(0, start) + "…";
  }
  return paragraph;
}

}  // namespace rigor::inline report
