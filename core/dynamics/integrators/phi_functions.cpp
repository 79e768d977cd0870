#include "core/dynamics/integrators/phi_functions.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline dynamics {
namespace {

constexpr int kLast = 4;
constexpr std::array<double, kLast + 1> kFactorial = {1, 1, 2, 6, 24};

// For a norm of at most 1/2: the first term left out is below 2e-17 of the first.
PhiFunctions by_series(const Mat12& z) {
  constexpr int kTerms = 12;
  const Mat12 one = Mat12::Identity();
  PhiFunctions phi;
  Mat12 horner = one;  // phi_4 times 4!
  for (int n = kTerms; n > 0; --n) horner = one + z * horner / (kLast + n);
  phi[kLast] = horner / kFactorial[kLast];
  for (int k = kLast; k > 0; --k) phi[k - 1] = one / kFactorial[k - 1] + z * phi[k];
  return phi;
}

// From those of z.
PhiFunctions of_twice(const PhiFunctions& phi) {
  PhiFunctions twice;
  twice[0] = phi[0] * phi[0];
  for (int k = 1; k <= kLast; ++k) {
    twice[k] = phi[0] * phi[k];
    for (int j = 1; j <= k; ++j) twice[k] += phi[j] / kFactorial[k - j];
    twice[k] /= std::exp2(k);
  }
  return twice;
}

}  // namespace

PhiFunctions phi_functions(const Mat12& z) {
  const double norm = z.cwiseAbs().rowwise().sum().maxCoeff();
  int doublings = 0;
  while (std::ldexp(0.5, doublings) < norm) ++doublings;
  PhiFunctions phi = by_series(z / std::exp2(doublings));
  for (int k = 0; k < doublings; ++k) phi = of_twice(phi);
  return phi;
}

}  // namespace rigor::inline dynamics
