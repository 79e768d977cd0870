#include "cases/metrics/measures/energy_distance.h"

#include <cmath>
#include <numeric>
#include <random>
#include <utility>

namespace rigor::inline metric {
namespace {

double distance(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (a[k] - b[k]) * (a[k] - b[k]);
  return std::sqrt(sum);
}

struct Means {
  double across, within_x, within_y;
  double energy() const { return 2 * across - within_x - within_y; }  // D²
};

class Pooled {
 public:
  Pooled(const Points& x, const Points& y) : of_x_(x.size()), size_(x.size() + y.size()), distances_(size_ * size_) {
    const auto point = [&](std::size_t i) -> const auto& { return i < of_x_ ? x[i] : y[i - of_x_]; };
    for (std::size_t i = 0; i < size_; ++i) {
      for (std::size_t j = 0; j < i; ++j)
        distances_[i * size_ + j] = distances_[j * size_ + i] = distance(point(i), point(j));
    }
  }
  std::size_t size() const { return size_; }

  // The points in this order, of which as many as there were in x belong to it. The V-statistic: a point and itself
  // count as a pair, so that D² is never negative.
  Means means(const std::vector<std::size_t>& order) const {
    double xx = 0, xy = 0, yy = 0;
    for (std::size_t i = 0; i < size_; ++i) {
      const double* row = &distances_[order[i] * size_];
      for (std::size_t j = 0; j < i; ++j) (i < of_x_ ? xx : j < of_x_ ? xy : yy) += row[order[j]];
    }
    const auto m = static_cast<double>(of_x_), n = static_cast<double>(size_ - of_x_);
    return {xy / (m * n), 2 * xx / (m * m), 2 * yy / (n * n)};
  }

 private:
  std::size_t of_x_, size_;
  std::vector<double> distances_;
};

// Its own shuffle and numbers, so that they are the same with every library.
void shuffle(std::vector<std::size_t>& order, std::mt19937_64& random) {
  for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[random() % (i + 1)]);
}

}  // namespace

EnergyTest energy_test(const Points& x, const Points& y, int permutations, std::uint64_t seed) {
  const Pooled pooled(x, y);
  std::vector<std::size_t> order(pooled.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const Means found = pooled.means(order);
  if (found.across == 0) return {};
  // A random division counts as equally large if only rounding separates it from the observed one.
  const double least = found.energy() - 1e-12 * found.across;
  std::mt19937_64 random(seed);
  int as_large = 0;
  for (int k = 0; k < permutations; ++k) {
    shuffle(order, random);
    if (pooled.means(order).energy() >= least) ++as_large;
  }
  return {found.energy() / (2 * found.across), (1.0 + as_large) / (1.0 + permutations)};
}

}  // namespace rigor::inline metric
