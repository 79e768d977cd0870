#include "core/base/portable.h"

#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <numbers>

#include "core/base/sine_polynomials.h"

namespace rigor::portable {
namespace {

struct Sum {  // of two doubles, the second below the first's last place
  double high, low;
};

// Exact (Knuth, 1969; Dekker, 1971).
Sum sum(double a, double b) {
  const double high = a + b, of_b = high - a;
  return {high, (a - (high - of_b)) + (b - of_b)};
}
Sum product(double a, double b) {
  constexpr double kSplit = 134217729;  // 2^27 + 1
  const auto high_half = [](double x) { return kSplit * x - (kSplit * x - x); };
  const double high = a * b, a1 = high_half(a), b1 = high_half(b), a2 = a - a1, b2 = b - b1;
  return {high, ((a1 * b1 - high) + a1 * b2 + a2 * b1) + a2 * b2};
}

// To the nearest whole number, up to 2^51.
double rounded(double x) {
  constexpr double kOnesPlace = 6755399441055744;  // 1.5 2^52, next to which doubles are whole
  return (x + kOnesPlace) - kOnesPlace;
}

double polynomial(double x, const double* begin, const double* end) {
  double value = *--end;
  while (end != begin) value = *--end + x * value;
  return value;
}

// An angle less a whole number of quarter turns, at most an eighth of a turn.
struct Reduced {
  int quarters;  // modulo 4
  Sum angle;     // rad
};

constexpr double kHalfPi[] = {1.5707963267948966, 6.123233995736766e-17, -1.4973849048591698e-33};

Reduced reduced(double x) {
  constexpr double kEighth = 0.25 * std::numbers::pi, kUnknown = 1e15;
  if (std::abs(x) <= kEighth) return {0, {x, 0}};
  if (std::abs(x) > kUnknown) x = std::fmod(x, 2 * std::numbers::pi);
  const double count = rounded(x / kHalfPi[0]);
  const Sum first = product(count, kHalfPi[0]), second = product(count, kHalfPi[1]);
  // The first difference is exact, because both are within a factor of two. Each following one is far smaller.
  const Sum without_low = sum(x - first.high, -first.low), rest = sum(without_low.high, -second.high);
  const double low = rest.low + (without_low.low - (second.low + count * kHalfPi[2]));
  const Sum angle = sum(rest.high, low);
  return {static_cast<int>(static_cast<std::int64_t>(count) & 3), angle};
}

double sine_of(Sum angle) {
  const double s = angle.high * angle.high, rest = s * polynomial(s, kSineQuotient, std::end(kSineQuotient));
  return angle.high + (angle.high * rest + angle.low * (1 - 0.5 * s));
}

double cosine_of(Sum angle) {
  const double s = angle.high * angle.high, half = 0.5 * s, most = 1 - half;
  const double rest = s * s * polynomial(s, kCosine + 1, std::end(kCosine));
  return most + (((1 - most) - half) + (rest - angle.high * angle.low));
}

// (atan t / t - 1) / t² as a polynomial in t², which meets it at Chebyshev's points of [0, 49/256] and leaves 4e-18.
constexpr double kArctangent[] = {-0.3333333333333333,  0.1999999999999941,    -0.14285714285566806,
                                  0.11111111096645038,  -0.09090908355602592,  0.07692285554889286,
                                  -0.06666241923359964, 0.05876946456755061,   -0.05216679739313656,
                                  0.04492259293193656,  -0.033128134256069586, 0.014773184616983806};

struct Direction {
  double tangent;
  Sum angle;  // rad
};
// Between which no tangent is farther than 7/16 from one of them, after rotation by its angle.
constexpr Direction kDirections[] = {{0.5, {0.4636476090008061, 2.2698777452961687e-17}},
                                     {1, {0.7853981633974483, 3.061616997868383e-17}}};

// Of a point with 0 <= y <= x and x > 0.
Sum angle_in_eighth(double y, double x) {
  Sum angle = {0, 0};
  double tangent = y / x;
  if (tangent > 7.0 / 16) {
    const Direction& near = kDirections[tangent > 11.0 / 16];
    angle = near.angle;
    tangent = (y - near.tangent * x) / (x + near.tangent * y);
  }
  const double s = tangent * tangent;
  const double rest = tangent * s * polynomial(s, kArctangent, std::end(kArctangent));
  const Sum total = sum(angle.high, tangent);
  return {total.high, total.low + (rest + angle.low)};
}

Sum minus(Sum a, const Sum& b) {
  const Sum high = sum(a.high, -b.high);
  return {high.high, high.low + (a.low - b.low)};
}

// Taylor's series of (exp r - 1 - r) / r², for |r| <= 0.35, where the next term is below 4e-18 of exp r.
constexpr double kExponential[] = {1.0 / 2,       1.0 / 6,        1.0 / 24,        1.0 / 120,
                                   1.0 / 720,     1.0 / 5040,     1.0 / 40320,     1.0 / 362880,
                                   1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};

}  // namespace

double sin(double x) {
  if (!std::isfinite(x)) return std::numeric_limits<double>::quiet_NaN();
  if (x == 0) return x;
  const auto [quarters, angle] = reduced(x);
  const double size = quarters % 2 == 0 ? sine_of(angle) : cosine_of(angle);
  return quarters < 2 ? size : -size;
}

double cos(double x) {
  if (!std::isfinite(x)) return std::numeric_limits<double>::quiet_NaN();
  const auto [quarters, angle] = reduced(x);
  const double size = quarters % 2 == 0 ? cosine_of(angle) : sine_of(angle);
  return quarters == 0 || quarters == 3 ? size : -size;
}

double atan2(double y, double x) {
  constexpr double kLeast = 1e-100, kMost = 1e100;
  constexpr Sum kQuarter = {kHalfPi[0], kHalfPi[1]}, kHalf = {2 * kHalfPi[0], 2 * kHalfPi[1]};
  if (std::isnan(x) || std::isnan(y)) return std::numeric_limits<double>::quiet_NaN();
  double across = std::abs(y), along = std::abs(x);
  if (std::isinf(across) || std::isinf(along)) across = std::isinf(across), along = std::isinf(along);
  // So that no sum overflows, and no quotient loses digits below the least normal number.
  const double larger = std::fmax(across, along);
  if (larger > 0 && (larger < kLeast || larger > kMost)) {
    const int exponent = std::ilogb(larger);
    across = std::ldexp(across, -exponent), along = std::ldexp(along, -exponent);
  }
  Sum angle = {0, 0};
  if (across > along)
    angle = minus(kQuarter, angle_in_eighth(along, across));
  else if (along > 0)
    angle = angle_in_eighth(across, along);
  if (std::signbit(x)) angle = minus(kHalf, angle);
  return std::copysign(angle.high + angle.low, y);
}

double exp(double x) {
  constexpr double kLog2 = 0.6931471803691238, kLog2Rest = 1.9082149292705877e-10;  // the first has 32 bits
  constexpr double kOverflow = 710, kUnderflow = -746;
  if (std::isnan(x)) return x;
  if (x > kOverflow) return std::numeric_limits<double>::infinity();
  if (x < kUnderflow) return 0;
  const double count = rounded(x / std::numbers::ln2);
  const double high = x - count * kLog2, low = count * kLog2Rest, r = high - low;
  const double lost = (high - r) - low;
  const double rest = r * r * polynomial(r, kExponential, std::end(kExponential)) + lost * (1 + r);
  return std::ldexp(1 + (r + rest), static_cast<int>(count));
}

}  // namespace rigor::portable
