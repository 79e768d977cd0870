#include "cases/truth/closed_form/smooth/jacobi_elliptic.h"

#include <algorithm>
#include <boost/math/special_functions/ellint_rf.hpp>
#include <cmath>
#include <limits>
#include <numbers>

namespace rigor::inline truth {
namespace {

constexpr long double kRounding = std::numeric_limits<long double>::epsilon();
constexpr long double kLongPi = std::numbers::pi_v<long double>;

}  // namespace

// Gauss's transformation to the smaller modulus k1 = (1 - k') / (1 + k'), until it is that of the circular functions
// (Abramowitz and Stegun, 16.12). With s = sn(v, k1), the numerator of dn, 1 - k1 s², is cn² + (1 - k1) s².
JacobiElliptic jacobi_elliptic(long double u, long double complement) {
  if (complement == 0) return {std::tanh(u), 1 / std::cosh(u), 1 / std::cosh(u)};
  const long double k1 = (1 - complement) / (1 + complement);
  if (k1 < kRounding) return {std::sin(u), std::cos(u), 1};
  const JacobiElliptic v = jacobi_elliptic(u / (1 + k1), 2 * std::sqrt(complement) / (1 + complement));
  const long double square = v.sn * v.sn, one_less_k1 = 2 * complement / (1 + complement), below = 1 + k1 * square;
  return {(1 + k1) * v.sn / below, v.cn * v.dn / below, (v.cn * v.cn + one_less_k1 * square) / below};
}

// pi / 2 over the arithmetic-geometric mean of 1 and k' (Abramowitz and Stegun, 17.6).
long double quarter_period(long double complement) {
  long double a = 1, b = complement;
  while (a - b > 4 * kRounding * a) {
    const long double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return kLongPi / (a + b);
}

// Carlson's form of the first integral, F = s R_F(c², c² + k'² s², 1) (Carlson, Numerische Mathematik 33, 1979).
long double jacobi_argument(long double s, long double c, long double complement) {
  const long double length = std::hypot(s, c);
  if (length == 0) return 0;
  const long double sn = s / length, cn = c / length, dn_squared = cn * cn + complement * complement * sn * sn;
  if (dn_squared == 0) return std::copysign(std::numeric_limits<long double>::infinity(), s);
  return sn * boost::math::ellint_rf(cn * cn, dn_squared, 1.0L);
}

DnQuadrature::DnQuadrature(long double a, long double complement) : a_(a) {
  if (complement == 0) return;
  quarter_period_ = quarter_period(complement);
  const long double modulus = std::max(kRounding, std::sqrt((1 - complement) * (1 + complement)));
  // The n-th coefficient falls as exp(-n pi K' / K), because the nearest pole is that of dn, at i K'. After 16 K / K'
  // coefficients they are below 1e-21.
  find_waves(8 + static_cast<int>(16 * quarter_period_ / quarter_period(modulus)), complement);
}

// Fourier's coefficients by the trapezoidal rule, which is as exact for a periodic function as there are coefficients.
void DnQuadrature::find_waves(int modes, long double complement) {
  std::vector<long double> cosines(2 * modes), samples(modes + 1);
  for (int j = 0; j < 2 * modes; ++j) cosines[j] = std::cos(j * kLongPi / modes);
  for (int j = 0; j <= modes; ++j) {
    const bool is_end = j == 0 || j == modes;
    samples[j] = (is_end ? 0.5L : 1) / (1 + a_ * jacobi_elliptic(j * quarter_period_ / modes, complement).dn) / modes;
  }
  for (int n = 0; n < modes; ++n) {
    long double sum = 0;
    for (int j = 0; j <= modes; ++j) sum += samples[j] * cosines[static_cast<long>(n) * j % (2 * modes)];
    if (n == 0) mean_ = sum;
    if (n > 0) waves_.push_back(2 * sum * quarter_period_ / (n * kLongPi));
  }
}

long double DnQuadrature::waves(long double u) const {
  if (quarter_period_ == 0) {
    // dn is 1 / cosh, and the integral u - 2 a / sqrt(1 - a²) atan(sqrt((1 - a) / (1 + a)) tanh(u / 2)).
    const long double less = 1 - a_, more = 1 + a_;
    return -2 * a_ / std::sqrt(less * more) * std::atan(std::sqrt(less / more) * std::tanh(u / 2));
  }
  // Clenshaw's recurrence.
  const long double x = std::remainder(u, 2 * quarter_period_) * kLongPi / quarter_period_, twice_cos = 2 * std::cos(x);
  long double later = 0, now = 0;
  for (auto wave = waves_.rbegin(); wave != waves_.rend(); ++wave) {
    const long double sooner = *wave + twice_cos * now - later;
    later = now, now = sooner;
  }
  return now * std::sin(x);
}

}  // namespace rigor::inline truth
