#include "cases/truth/closed_form/joint/even_quadrature.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rigor::inline truth {
namespace {

constexpr long double kLongPi = std::numbers::pi_v<long double>;

struct Series {
  std::vector<long double> coefficients;  // of cos(n pi u / K), n = 0, 1, ..
  long double largest = 0;                // of the function
};

// Uses the trapezoidal rule.
Series series_of(const std::function<long double(long double)>& function, long double K, int modes) {
  std::vector<long double> cosines(2 * modes), samples(modes + 1);
  Series found;
  for (int j = 0; j < 2 * modes; ++j) cosines[j] = std::cos(j * kLongPi / modes);
  for (int j = 0; j <= modes; ++j) {
    const long double value = function(j * K / modes);
    found.largest = std::max(found.largest, std::abs(value));
    samples[j] = (j == 0 || j == modes ? 0.5L : 1) * value / modes;
  }
  for (int n = 0; n < modes; ++n) {
    long double sum = 0;
    for (int j = 0; j <= modes; ++j) sum += samples[j] * cosines[static_cast<long>(n) * j % (2 * modes)];
    found.coefficients.push_back(n == 0 ? sum : 2 * sum);
  }
  return found;
}

}  // namespace

EvenQuadrature::EvenQuadrature(const std::function<long double(long double u)>& function, long double quarter_period)
    : quarter_period_(quarter_period) {
  constexpr int kFewest = 16, kMost = 1024;
  for (int modes = kFewest; modes <= kMost && !converges_; modes *= 2) {
    const Series found = series_of(function, quarter_period, modes);
    long double last = 0;
    for (int n = modes - modes / 8; n < modes; ++n) last = std::max(last, std::abs(found.coefficients[n]));
    // A tenth of a double's rounding; the mean is then as good as its square.
    converges_ = last <= 1e-17L * found.largest;
    mean_ = found.coefficients[0];
    waves_.clear();
    for (int n = 1; n < modes; ++n) waves_.push_back(found.coefficients[n] * quarter_period / (n * kLongPi));
  }
}

long double EvenQuadrature::at(long double u) const {
  // Clenshaw's recurrence.
  const long double x = std::remainder(u, 2 * quarter_period_) * kLongPi / quarter_period_, twice_cos = 2 * std::cos(x);
  long double later = 0, now = 0;
  for (auto wave = waves_.rbegin(); wave != waves_.rend(); ++wave) {
    const long double sooner = *wave + twice_cos * now - later;
    later = now, now = sooner;
  }
  return mean_ * u + now * std::sin(x);
}

}  // namespace rigor::inline truth
