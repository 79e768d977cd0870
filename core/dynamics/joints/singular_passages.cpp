#include "core/dynamics/joints/singular_passages.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace rigor::inline dynamics {
namespace {

constexpr std::size_t kMostNamed = 5;
constexpr double kSmall = 1e-2;  // a tenth of a radian away, for links of like lengths
// Relative to the neighbouring pivots: the least value of the parabola at a passage. It is of third order in a step of
// a tenth of a radian. A mechanism that only comes near, to a pivot p, stays far above it while a step's own share is
// less than 4 p.
constexpr double kNothing = 0.2;

}  // namespace

void SingularPassages::note(double t, double pivot) {
  if (known_ == 2 && last_.pivot < kSmall && last_.pivot <= before_.pivot && last_.pivot < pivot) {
    // last + b x + c x² through all three, x from the last.
    const double x0 = before_.t - last_.t, x2 = t - last_.t, slope0 = (before_.pivot - last_.pivot) / x0,
                 slope2 = (pivot - last_.pivot) / x2, c = (slope2 - slope0) / (x2 - x0), b = slope2 - c * x2;
    const double lowest = last_.pivot - b * b / (4 * c);
    if (lowest < kNothing * std::min(before_.pivot, pivot)) {
      ++count_;
      if (times_.size() < kMostNamed) times_.push_back(last_.t - b / (2 * c));
    }
  }
  before_ = last_, last_ = {t, pivot};
  known_ = std::min(known_ + 1, 2);
}

std::string SingularPassages::text() const {
  if (times_.empty()) return "";
  std::vector<std::string> named;
  for (const double t : times_) named.push_back(fmt::format("{:.4g} s", t));
  const long others = count_ - static_cast<long>(times_.size());
  return fmt::format("at {}{}", fmt::join(named, ", "), others > 0 ? fmt::format(" and {} more", others) : "");
}

}  // namespace rigor::inline dynamics
