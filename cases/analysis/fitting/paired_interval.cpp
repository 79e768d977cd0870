#include "cases/analysis/fitting/paired_interval.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace rigor {
namespace {

constexpr double kErrors = 0.98;               // standard errors of the mean difference
constexpr int kHalvings = 3;                   // of the way from the best value to the end of the range
constexpr std::size_t kEvaluationsAnAxis = 8;  // for each value that is fitted again

double mean_loss(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

// Whether the trials, each compared with itself, allow for the point.
bool is_within(const std::vector<double>& there, const std::vector<double>& at_best) {
  std::vector<double> differences;
  for (std::size_t t = 0; t < there.size(); ++t) differences.push_back(there[t] - at_best[t]);
  const double mean = mean_loss(differences);
  double squares = 0;
  for (const double one : differences) squares += (one - mean) * (one - mean);
  const auto n = static_cast<double>(differences.size());
  return mean <= kErrors * std::sqrt(squares / (n - 1) / n);
}

class PairedSearch {
 public:
  PairedSearch(const BoxPoint& best, std::size_t axis, const LossesOfTrials& losses)
      : best_(best), axis_(axis), losses_(losses), at_best_(losses({best}).front()) {}

  // The value nearest to `end`, from the best one on, that the trials allow for; none if that is `end` itself.
  std::optional<double> edge_towards(double end) {
    others_ = without_axis(best_);
    double inside = best_[axis_], outside = end;
    if (is_within(fitted_again(end), at_best_)) return {};
    for (int halving = 0; halving < kHalvings; ++halving) {
      const double middle = 0.5 * (inside + outside);
      (is_within(fitted_again(middle), at_best_) ? inside : outside) = middle;
    }
    return outside;
  }

 private:
  BoxPoint without_axis(BoxPoint point) const {
    point.erase(point.begin() + static_cast<long>(axis_));
    return point;
  }
  BoxPoint with_axis(BoxPoint others, double value) const {
    others.insert(others.begin() + static_cast<long>(axis_), value);
    return others;
  }

  // The losses at the value with the others as good as they get; a search begins where the last one ended.
  std::vector<double> fitted_again(double value) {
    const auto losses_at = [&](const BoxPoint& others) { return losses_({with_axis(others, value)}).front(); };
    if (others_.empty()) return losses_at({});
    const std::function<double(const BoxPoint&)> function = [&](const BoxPoint& others) {
      return mean_loss(losses_at(others));
    };
    others_ = nelder_mead(function, {others_, function(others_)}, {0.1, 1e-2, kEvaluationsAnAxis * others_.size()}).at;
    return losses_at(others_);
  }

  const BoxPoint& best_;
  std::size_t axis_;
  const LossesOfTrials& losses_;
  std::vector<double> at_best_;
  BoxPoint others_;
};

}  // namespace

PairedInterval paired_interval(const BoxPoint& best, std::size_t axis, const LossesOfTrials& losses) {
  PairedSearch search(best, axis, losses);
  const auto low = search.edge_towards(0), high = search.edge_towards(1);
  return {low.value_or(0), high.value_or(1), !low, !high};
}

}  // namespace rigor
