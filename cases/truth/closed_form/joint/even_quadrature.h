// The integral of a smooth, even function of Jacobi's argument with period 2 K, as mean u + waves(u). A Fourier series
// gives it; its accuracy depends only on the number of coefficients (Trefethen and Weideman, SIAM Review 56, 2014).
#pragma once

#include <functional>
#include <vector>

namespace rigor::inline truth {

class EvenQuadrature {
 public:
  EvenQuadrature() = default;
  EvenQuadrature(const std::function<long double(long double u)>& function, long double quarter_period);

  // Whether the coefficients fall to rounding; if not, the function has a pole too close by.
  bool converges() const { return converges_; }
  long double at(long double u) const;  // the integral from 0 to u

 private:
  long double quarter_period_ = 1, mean_ = 0;
  std::vector<long double> waves_;  // coefficients of sin(n pi u / K), n = 1, 2, ..
  bool converges_ = false;
};

}  // namespace rigor::inline truth
