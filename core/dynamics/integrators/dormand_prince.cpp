// The adaptive Runge–Kutta pair of order 8 by Dormand and Prince on (x, q, v, L). Each step of dt is divided into inner
// steps. The embedded formulas of order 5 and 3 estimate the error of each inner step, until it is below the tolerance,
// as
//   e5² / sqrt(e5² + e3²/100),
// is below the tolerance (relative_size() of motion_equations.h). A timed force that begins or ends inside the step
// divides it there. Every step begins with the whole of dt: nothing is remembered from the one before.
#include <fmt/format.h>
#include <numeric>

#include <algorithm>

#include "core/dynamics/integrators/dormand_prince_tableau.h"
#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/joints/joints.h"
#include "core/dynamics/model/motion_equations.h"
#include "core/engine/option_values.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

using dormand_prince::kStages;

constexpr int kMostTries = 20000;  // inner steps, refused ones included, in one step
// As a share of a step of jointed bodies. If such a short inner step is refused, the bodies are in a singular position.
// The error is then rounding, and no step is short enough.
constexpr double kShortest = 1e-6;
constexpr int kMostTriesBeyond = 16;  // in each step after such a refusal, because the motion is uncertain in any case

class DormandPrince : public Stepper {
 public:
  explicit DormandPrince(const StepperParts& parts)
      : parts_(parts),
        tolerance_(number_option(parts.settings, kToleranceOption)),
        equations_(parts.system, parts.constraints()),
        y_(parts.system.size()),
        next_(parts.system.size()),
        estimate_(parts.system.size()) {
    equations_.keep_stages(kStages);
  }

  void step(MutableBodyColumns state, double t, double dt) override {
    solver_warning_.clear();
    if (parts_.contact) {
      parts_.system.wrenches(state, t, dt, wrenches_);
      resolve_ahead(*parts_.contact, parts_.system, wrenches_, dt, state);
    }
    equations_.begin(state, y_);
    parts_.system.loads.for_each_smooth_part(t, dt, [&](double from, double length) { smooth_part(from, length); });
    equations_.write(y_, state);
    if (parts_.joints) parts_.joints->project(state);
  }

  std::string solver_warning() const override { return solver_warning_; }
  void archive_state(StateArchive& archive) override { archive(is_beyond_, solver_warning_); }

 private:
  // Advances y_ over [t, t + length] in equal steps, and chooses their number again after each of them.
  void smooth_part(double t, double length) {
    double left = length, longest = std::abs(length);
    int tries = 0;
    equations_.rates(y_, t, length, equations_.rates_of_stage(0), ConstraintForces::Rows::chosen_anew, t);
    while (left != 0) {
      const double count = std::ceil(std::abs(left) / longest), h = left / count;
      const std::string noted = parts_.joints ? parts_.joints->noted() : "";
      take_stages(t, length, t + (length - left), h);
      const double error = error_of_stages(h) / tolerance_;
      const bool is_stuck = parts_.joints && error > 1 && std::abs(h) < kShortest * std::abs(length);
      const bool given_up =
          ++tries >= (is_beyond_ ? kMostTriesBeyond : kMostTries) || is_stuck || !is_finite(y_) || !std::isfinite(h);
      if (!(error <= 1 || given_up)) {
        if (parts_.joints) parts_.joints->note_only(noted);
      } else {
        std::swap(y_, next_);
        left = count == 1 || given_up ? 0 : left - h;
        if (left != 0)
          equations_.rates(y_, t, length, equations_.rates_of_stage(0), ConstraintForces::Rows::chosen_anew,
                           t + (length - left));
      }
      if (given_up) {
        is_beyond_ |= is_stuck;
        solver_warning_ = fmt::format(
            "{}the tolerance of {} was not met in {} inner steps; the rest of the step was "
            "left out",
            is_stuck ? "in a singular position of the joints, or beside it, " : "", tolerance_, tries);
      }
      longest = std::abs(h) * next_length(error);
    }
  }

  // The factor by which the next inner step may be longer.
  static double next_length(double error) {
    constexpr double kSafety = 0.9, kLeast = 0.1, kMost = 6;
    if (!std::isfinite(error)) return kLeast;
    return error == 0 ? kMost : std::clamp(kSafety / std::sqrt(std::sqrt(std::sqrt(error))), kLeast, kMost);
  }

  // Computes the other stages and next_ from y_, which belongs to `now`, and its rates in stage 0.
  void take_stages(double t, double dt, double now, double h) {
    for (std::size_t s = 1; s < kStages; ++s) {
      const auto weights = std::span(dormand_prince::kStage[s]).first(s);
      equations_.combine(&y_, h, weights, next_);
      equations_.rates(next_, t, dt, equations_.rates_of_stage(s), ConstraintForces::Rows::as_chosen,
                       now + h * std::accumulate(weights.begin(), weights.end(), 0.0));
    }
    equations_.combine(&y_, h, dormand_prince::kWeight, next_);
  }

  double error_of_stages(double h) {
    equations_.combine(nullptr, h, dormand_prince::kError5, estimate_);
    const double error5 = equations_.relative_size(estimate_, y_);
    equations_.combine(nullptr, h, dormand_prince::kError3, estimate_);
    const double error3 = equations_.relative_size(estimate_, y_);
    return error5 == 0 ? 0 : std::abs(h) * error5 * error5 / std::hypot(error5, 0.1 * error3);
  }

  static bool is_finite(const BodyTable& y) {
    for (int c = 0; c < kRotation; ++c) {
      const double* column = y.columns().column(c);
      if (!std::all_of(column, column + y.size(), [](double x) { return std::isfinite(x); })) return false;
    }
    return true;
  }

  StepperParts parts_;
  double tolerance_;
  MotionEquations equations_;
  Wrenches wrenches_;
  BodyTable y_, next_, estimate_;
  bool is_beyond_ = false;  // a singular position that it could not pass
  std::string solver_warning_;
};

}  // namespace

extern const Integrator kDormandPrince;
const Integrator kDormandPrince = {
    .name = "dormand-prince",
    .summary = "adaptive Runge-Kutta of order 8: divides each step until its error meets the tolerance",
    .order = 8,
    .symplectic = false,
    .leapfrog_stagger = 0,
    .default_orientation = "",
    .adaptive = true,
    .takes_joints = true,
    .holds_at_stages = true,
    .options = {kToleranceOption},
    .make = make_stepper<DormandPrince>,
};

}  // namespace rigor::inline dynamics
