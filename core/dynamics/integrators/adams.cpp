// The Adams–Bashforth–Moulton method of order 7 on (x, q, v, L) (Hairer, Nørsett, Wanner, Solving Ordinary Differential
// Equations I, III.1). The explicit formula predicts, the loads are evaluated there, and the implicit formula corrects.
// A step of the method is four steps of the formula. Positions use the implicit formula with the velocities of the same
// instant, also in the prediction. This doubles the stable step of an oscillation, to w dt = 1.4. Each formula step
// evaluates the loads once, and with dampers a second time after the correction. Without the second evaluation a damped
// motion would soon be unstable; with it the limit is about c dt/m = 2.
//
// It remembers the rates of the last seven instants. At the start, where a timed force begins or ends, and after a
// change of dt, they are invalid. Steps of order 8 by Dormand and Prince then compute new ones.
#include <algorithm>
#include <cmath>

#include "core/dynamics/integrators/continuation.h"
#include "core/dynamics/integrators/dormand_prince_tableau.h"
#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/model/motion_equations.h"
#include "core/engine/state_archive.h"

namespace rigor::inline dynamics {
namespace {

constexpr int kParts = 4;  // steps of the formula in a step of the method

// Weights from the newest rates back in time. Those of the corrector follow kAtEnd, the weight of the rates at the
// step's end.
using AdamsCoefficients = std::array<double, kAdamsRates>;
constexpr double kOf = 60480;
constexpr AdamsCoefficients kPredictor = {198721 / kOf, -447288 / kOf, 705549 / kOf, -688256 / kOf,
                                          407139 / kOf, -134472 / kOf, 19087 / kOf};
constexpr double kAtEnd = 19087 / kOf;
constexpr AdamsCoefficients kCorrector = {
    65112 / kOf, -46461 / kOf, 37504 / kOf, -20211 / kOf, 6312 / kOf, -863 / kOf, 0};

class Adams : public Stepper {
 public:
  explicit Adams(const StepperParts& parts)
      : parts_(parts),
        stride_(parts.system.size() < kRowsPerLine ? parts.system.size() : column_stride(parts.system.size())),
        loads_(parts.system),
        stage_(parts.system.size()),
        last_(parts.system.size()),
        starter_(parts.system),
        start_(parts.system.size()),
        next_(parts.system.size()) {
    starter_.keep_stages(dormand_prince::kStages);
    for (AlignedDoubles* table : {&y_, &older_predictor_, &older_corrector_, &known_values_})
      table->resize(table_size());
    for (std::size_t s = 0; s < kAdamsRates; ++s) {
      rates_[s].resize(table_size());
      newest_first_[s] = rates_[s].data();
    }
  }

  void step(MutableBodyColumns state, double t, double dt) override {
    if (!goes_on(state, t, dt)) begin(state, dt);
    parts_.system.loads.for_each_smooth_part(t, dt, [&](double from, double length) {
      if (length == dt) {
        for (int k = 0; k < kParts; ++k) step_of_formula(from, dt);
      } else {
        known_ = 0;
        const int count = static_cast<int>(std::ceil(kParts * length / dt));
        for (int k = 0; k < count; ++k) starting_step(from, length, length / count);
        known_ = 0;
      }
    });
    write(state);
    last_.ended(state, t + dt, dt);
  }

  void archive_state(StateArchive& archive) override {
    archive(y_, older_predictor_, older_corrector_, known_values_, known_, stage_, last_, dt_);
    if (archive.restores()) {  // then the newest rates stand first
      for (std::size_t s = 0; s < kAdamsRates; ++s) newest_first_[s] = rates_[s].data();
    }
    for (double* rates : newest_first_) archive.numbers(rates, table_size());
  }

 private:
  // Tables of few bodies are packed, so that a vector register takes several columns of a row at once.
  bool packed() const { return stride_ < kRowsPerLine; }
  // With room for a whole register at the last row of the last column.
  std::size_t table_size() const { return column_stride(kRotation * stride_ + kRowsPerLine); }

  bool goes_on(BodyColumns state, double t, double dt) const {
    return last_.goes_on(state, t, dt, parts_.system.loads, t - static_cast<double>(known_) * dt / kParts);
  }

  void begin(BodyColumns state, double dt) {
    starter_.begin(state, start_);
    copy(start_, y_.data());
    known_ = 0, dt_ = dt;
  }

  void step_of_formula(double t, double dt) {
    if (known_ < kAdamsRates) {
      starting_step(t, dt, dt / kParts);
      if (known_ == kAdamsRates) advance(nullptr, AdamsRatesFrom::table);
      return;
    }
    make_room();
    advance(loads_.over_step(stage_.columns(), t, dt), AdamsRatesFrom::stage);
    if (!parts_.system.loads.damped()) return;
    write(stage_.columns());
    advance(loads_.over_step(stage_.columns(), t, dt), AdamsRatesFrom::y);
  }

  void write(MutableBodyColumns state) const {
    parts_.system.constants.for_each_block(
        [&](const Bodies& block) { kernels().motion_of(block, y_.data(), stride_, state.column(0)); });
  }

  // Goes on to the newest rates and predicts the step after.
  void advance(const double* wrench, AdamsRatesFrom from) {
    const AdamsTables tables = {y_.data(),
                                older_predictor_.data(),
                                older_corrector_.data(),
                                known_values_.data(),
                                stride_,
                                stage_.columns().column(0),
                                dt_ / kParts};
    AdamsRates rates = {{}, kPredictor.data(), kCorrector.data()};
    std::copy(newest_first_.begin() + 1, newest_first_.end(), rates.rates);
    const AdamsWeights weights = {kPredictor[0], kCorrector[0], kAtEnd};
    const bool damped = parts_.system.loads.damped();
    parts_.system.constants.for_each_block([&](const Bodies& block) {
      add_up(block, rates, tables);
      kernels().adams_advance(block, tables, weights, wrench, newest_first_[0], from, damped);
    });
  }

  void add_up(const Bodies& block, const AdamsRates& rates, const AdamsTables& tables) const {
    if (packed()) return kernels().sums_of_older(0, kRotation * stride_, rates, tables);
    for (std::size_t c = 0; c < kRotation; ++c)
      kernels().sums_of_older(c * stride_ + block.begin, c * stride_ + block.end, rates, tables);
  }

  // A step of order 8 by h; keeps the rates at its end.
  void starting_step(double t, double dt, double h) {
    copy(y_, start_);
    if (known_ == 0) keep_rates(start_, t, dt);
    for (std::size_t s = 0; s < dormand_prince::kStages; ++s) {
      if (s > 0) starter_.combine(&start_, h, std::span(dormand_prince::kStage[s]).first(s), next_);
      starter_.rates(s == 0 ? start_ : next_, t, dt, starter_.rates_of_stage(s));
    }
    starter_.combine(&start_, h, dormand_prince::kWeight, next_);
    copy(next_, y_.data());
    keep_rates(next_, t, dt);
  }

  void keep_rates(const BodyTable& y, double t, double dt) {
    starter_.rates(y, t, dt, starter_.rates_of_stage(0));
    make_room();
    copy(starter_.rates_of_stage(0), newest_first_[0]);
    ++known_;
  }

  // The oldest rates give their place to new ones.
  void make_room() { std::rotate(newest_first_.begin(), newest_first_.end() - 1, newest_first_.end()); }

  void copy(const BodyTable& from, double* to) const {
    for (std::size_t c = 0; c < kRotation; ++c)
      std::copy_n(from.columns().column(static_cast<int>(c)), from.size(), to + c * stride_);
  }
  void copy(const AlignedDoubles& from, BodyTable& to) const {
    for (std::size_t c = 0; c < kRotation; ++c)
      std::copy_n(from.data() + c * stride_, to.size(), to.columns().column(static_cast<int>(c)));
  }

  StepperParts parts_;
  std::size_t stride_;                                                   // of the tables below, see packed()
  AlignedDoubles y_, older_predictor_, older_corrector_, known_values_;  // see AdamsTables
  std::array<AlignedDoubles, kAdamsRates> rates_;
  std::array<double*, kAdamsRates> newest_first_;  // of rates_
  std::size_t known_ = 0;                          // how many of them are valid
  WrenchColumns loads_;
  BodyTable stage_;
  Continuation last_;
  double dt_ = 0;
  MotionEquations starter_;
  BodyTable start_, next_;
};

}  // namespace

extern const Integrator kAdams;
const Integrator kAdams = {
    .name = "adams",
    .summary =
        "Adams-Bashforth-Moulton; four steps of the formula a step, each with one evaluation of the loads; no "
        "joints, for bringing a state back to them makes the rates it remembers those of another motion",
    .order = kAdamsRates,
    .symplectic = false,
    .leapfrog_stagger = 0,
    .default_orientation = "",
    .takes_contact = false,
    .make = make_stepper<Adams>,
};

}  // namespace rigor::inline dynamics
