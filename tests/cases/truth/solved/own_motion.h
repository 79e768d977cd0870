// A small solver of its own for tests: the classical Runge-Kutta method in even steps, up to the root of an event. It
// shares nothing with the core.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <functional>

namespace rigor::test {

struct OwnMotion {
  using State = Eigen::VectorXd;
  using Rates = std::function<State(double t, const State& x)>;
  using Event = std::function<double(double t, const State& x)>;

  double t = 0;
  State x;

  void step(const Rates& f, double h) {
    const State k1 = f(t, x), k2 = f(t + 0.5 * h, x + 0.5 * h * k1), k3 = f(t + 0.5 * h, x + 0.5 * h * k2),
                k4 = f(t + h, x + h * k3);
    x += h / 6 * (k1 + 2 * k2 + 2 * k3 + k4), t += h;
  }

  // In steps of at most h(x), until `end` or until the event falls below zero. Returns whether it did.
  bool go(const Rates& f, const Event& event, double end, const std::function<double(const State&)>& h) {
    while (t < end) {
      const OwnMotion before = *this;
      const double length = std::min(h(x), end - t);
      step(f, length);
      if (length == end - before.t) t = end;
      if (!(event(t, x) < 0)) continue;
      double low = 0, high = length;
      for (int k = 0; k < 60; ++k) {
        const double middle = 0.5 * (low + high);
        *this = before, step(f, middle);
        (event(t, x) < 0 ? high : low) = middle;
      }
      *this = before, step(f, high);
      return true;
    }
    return false;
  }
  bool go(const Rates& f, const Event& event, double end, double h) {
    return go(f, event, end, [h](const State&) { return h; });
  }
};

}  // namespace rigor::test
