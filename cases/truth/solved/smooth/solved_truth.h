// A truth from a numerical solution that others have judged: its state at any time, by one step from the node before.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "cases/truth/solved/solving.h"
#include "cases/truth/truth.h"

namespace rigor::inline truth {

class SolvedTruth final : public Truth {
 public:
  // `motion`: the equations of the solution.
  SolvedTruth(std::unique_ptr<solving::DoubleMotion> motion, ReferenceSolution solution, std::string caveat = "")
      : motion_(std::move(motion)), solution_(std::move(solution)), caveat_(std::move(caveat)) {}

  void at(double t, MutableBodyColumns out) const override {
    motion_->write(solving::state_at(solution_, *motion_, t).data(), out);
  }
  double error(double t) const override {
    const auto next = std::lower_bound(solution_.error_times.begin(), solution_.error_times.end(), t);
    if (next != solution_.error_times.end()) return solution_.errors[next - solution_.error_times.begin()];
    return solution_.complete ? solution_.errors.back() : std::numeric_limits<double>::infinity();
  }
  std::string caveat() const override { return caveat_; }

 private:
  std::unique_ptr<solving::DoubleMotion> motion_;  // for the step from a node
  ReferenceSolution solution_;
  std::string caveat_;
};

}  // namespace rigor::inline truth
