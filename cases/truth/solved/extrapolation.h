// Gragg's modified midpoint rule with 2, 4, .. 2 K substeps, extrapolated to step zero by Aitken and Neville: a step of
// order 2 K for any number type (Hairer, Nørsett, Wanner, Solving Ordinary Differential Equations I, section II.9). The
// order can be arbitrarily high, as quadruple precision needs. The step's error estimate is that of the next lower
// order.
#pragma once

#include <algorithm>
#include <boost/numeric/odeint/stepper/controlled_step_result.hpp>
#include <cmath>
#include <vector>

namespace rigor::inline truth {

template <typename Real>
class Extrapolation {
 public:
  using State = std::vector<Real>;

  // The tolerance is relative and absolute, per step.
  Extrapolation(int columns, double tolerance) : columns_(columns), tolerance_(tolerance) {}

  // Moves the state and t by h if the error allows it, and sets the next h, like odeint's controlled steppers.
  template <typename System>
  boost::numeric::odeint::controlled_step_result try_step(System system, State& state, Real& t, Real& h) {
    system(state, slope_, t);
    const std::vector<State> row = last_row(system, state, t, h);
    const double error = error_of(row[columns_ - 1], row[columns_ - 2]);
    const bool good = error <= 1;
    if (good) t += h, state = row.back();
    // NaN shrinks the step as well.
    const double factor = 0.8 * std::pow(std::max(error, 1e-30), -1.0 / (2 * columns_ - 1));
    h *= Real(error >= 0 ? std::clamp(factor, 0.1, 4.0) : 0.1);
    return good ? boost::numeric::odeint::success : boost::numeric::odeint::fail;
  }

  // The end of a step of length h without error control, for a step shorter than an accepted one.
  template <typename System>
  State after(System& system, const State& state, const Real& t, const Real& h) {
    system(state, slope_, t);
    return last_row(system, state, t, h).back();
  }

 private:
  // The extrapolation table from a state at which slope_ was evaluated.
  template <typename System>
  std::vector<State> last_row(System& system, const State& state, const Real& t, const Real& h) const {
    std::vector<State> row;
    for (int k = 0; k < columns_; ++k) {
      const std::vector<State> above = row;
      row = {midpoints(system, state, t, h, 2 * (k + 1))};
      for (int c = 1; c <= k; ++c) row.push_back(extrapolated(row[c - 1], above[c - 1], k + 1, k + 1 - c));
    }
    return row;
  }

  template <typename System>
  State midpoints(System& system, const State& start, const Real& t, const Real& h, int substeps) const {
    const Real s = h / substeps;
    State before = start, now = start, slope(start.size());
    for (std::size_t i = 0; i < start.size(); ++i) now[i] += s * slope_[i];
    for (int j = 1; j < substeps; ++j) {
      system(now, slope, t + j * s);
      for (std::size_t i = 0; i < start.size(); ++i) before[i] += 2 * s * slope[i];
      before.swap(now);
    }
    return now;
  }

  // From a finer and a coarser result, with `fine` and `coarse` pairs of substeps.
  static State extrapolated(const State& finer, const State& coarser, int fine, int coarse) {
    const Real ratio = Real(fine) / coarse, weight = 1 / (ratio * ratio - 1);
    State result = finer;
    for (std::size_t i = 0; i < result.size(); ++i) result[i] += weight * (finer[i] - coarser[i]);
    return result;
  }

  // In units of the tolerance.
  double error_of(const State& state, const State& lower_order) const {
    double largest = 0;
    for (std::size_t i = 0; i < state.size(); ++i) {
      const double error = static_cast<double>(state[i] - lower_order[i]), size = static_cast<double>(state[i]);
      const double share = std::abs(error) / (tolerance_ * (1 + std::abs(size)));
      if (!(share <= largest)) largest = share;
    }
    return largest;
  }

  int columns_;
  double tolerance_;
  State slope_;  // where the step begins
};

}  // namespace rigor::inline truth
