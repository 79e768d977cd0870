// Products and triangular solves of joint blocks: up to six by six, column by column without gaps, with the number of
// rows known at compile time. Larger libraries lose more time in calls and generality than the arithmetic takes.
#pragma once

#include <type_traits>

#include "core/dynamics/joints/constraint_rows.h"

namespace rigor::inline dynamics {

// Calls f with `rows`, 1 to 6, as a type: f(std::integral_constant<int, rows>{}).
template <typename F>
void with_rows(int rows, const F& f) {
  switch (rows) {
    case 1:
      return f(std::integral_constant<int, 1>{});
    case 2:
      return f(std::integral_constant<int, 2>{});
    case 3:
      return f(std::integral_constant<int, 3>{});
    case 4:
      return f(std::integral_constant<int, 4>{});
    case 5:
      return f(std::integral_constant<int, 5>{});
    default:
      return f(std::integral_constant<int, 6>{});
  }
}

// Calls f with n as a constant if n is one of the common sizes beside R rows, so that its loops are unrolled.
template <int R, typename F>
void with_count(int n, const F& f) {
  if (n == R) return f(std::integral_constant<int, R>{});
  if (n == 6) return f(std::integral_constant<int, 6>{});
  if (n == 3) return f(std::integral_constant<int, 3>{});
  f(n);
}

// to (R x columns) += Sign a (R x inner) bᵀ, with b (columns x inner).
template <int R, int Sign = 1>
void add_product(double* to, const double* a, const double* b, int columns, int inner) {
  with_count<R>(columns, [&](auto n) {
    with_count<R>(inner, [&](auto m) {
      for (int j = 0; j < n; ++j) {
        double sum[R] = {};
        for (int k = 0; k < m; ++k) {
          const double factor = b[j + k * n];
          for (int i = 0; i < R; ++i) sum[i] += a[i + k * R] * factor;
        }
        for (int i = 0; i < R; ++i) to[i + j * R] += Sign * sum[i];
      }
    });
  });
}

// Of a lower triangular L the inverses of the diagonal are kept in its place: divisions take long.
// b (R x n) <- b L⁻ᵀ, L (n x n).
template <int R>
void solve_on_the_right(double* b, const double* L, int count) {
  with_count<R>(count, [&](auto n) {
    for (int k = 0; k < n; ++k) {
      double* const at = b + k * R;
      for (int l = 0; l < k; ++l) {
        const double factor = L[k + l * n];
        for (int i = 0; i < R; ++i) at[i] -= factor * b[i + l * R];
      }
      const double inverse = L[k + k * n];
      for (int i = 0; i < R; ++i) at[i] *= inverse;
    }
  });
}

// x <- L⁻¹ x, and x <- L⁻ᵀ x.
template <int R>
void solve_lower(const double* L, double* x) {
  for (int k = 0; k < R; ++k) {
    x[k] *= L[k + k * R];
    for (int i = k + 1; i < R; ++i) x[i] -= L[i + k * R] * x[k];
  }
}
template <int R>
void solve_lower_transposed(const double* L, double* x) {
  for (int k = R; k-- > 0;) {
    for (int i = k + 1; i < R; ++i) x[k] -= L[i + k * R] * x[i];
    x[k] *= L[k + k * R];
  }
}

// y (R) -= a (R x n) x, and y (n) -= aᵀ x (R).
template <int R>
void subtract_product(double* y, const double* a, const double* x, int count) {
  with_count<R>(count, [&](auto n) {
    double sum[R] = {};
    for (int k = 0; k < n; ++k) {
      for (int i = 0; i < R; ++i) sum[i] += a[i + k * R] * x[k];
    }
    for (int i = 0; i < R; ++i) y[i] -= sum[i];
  });
}
template <int R>
void subtract_transposed_product(double* y, const double* a, const double* x, int count) {
  with_count<R>(count, [&](auto n) {
    for (int k = 0; k < n; ++k) {
      double sum = 0;
      for (int i = 0; i < R; ++i) sum += a[i + k * R] * x[i];
      y[k] -= sum;
    }
  });
}

}  // namespace rigor::inline dynamics
