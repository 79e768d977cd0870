// The one shift in time of the whole truth that fits the run best: s minimises the misfit
//   J(s) = mean over samples of Σ m |p - P(t - s)|² + φᵀ I φ,  φ = 2 vec(Q(t - s)⁻¹ q),
// in which a metre and a radian weigh as they do in the kinetic energy. s > 0: the run lags; s < 0: it leads. The best
// of 33 shifts within half a period either way (a whole one cannot be told from none) brackets the root of dJ/ds. The
// truth's samples, continued at their own speed, tell which shift that is. The truth itself is asked there and beside
// it.
//
// The mean leaves out the ends of the run: the samples for which a shift would ask for the truth before its start or
// beyond its horizon. The search for the best of the 33 leaves out half a period at each end. The result leaves out no
// more than the shift itself and one 32nd of a period.
#include <fmt/format.h>

#include <boost/math/tools/roots.hpp>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/pose_gap.h"

namespace rigor::inline metric {
namespace {

constexpr int kEitherWay = 16;  // shifts tried

struct Misfit {
  double value = 0;  // kg m², J
  double slope = 0;  // kg m²/s, dJ/ds
};

class Fit {
 public:
  Fit(const JudgedRun& run, std::size_t count) : run_(run), count_(count), shifted_(run.scene.bodies.size()) {
    find_period();
    widest_ = std::min(period_ / 2, end() / 4);
    leave_out(widest_);
  }

  // At most 500 instants, none nearer to an end than `margin` [s]: the same for all shifts up to it. Fewer of jointed
  // bodies, whose truth takes up to a hundred times as long to answer: one number needs no more.
  void leave_out(double margin) {
    const std::size_t most = run_.scene.joints.empty() ? 500 : 40;
    constexpr double kRounding = 1e-9;  // of a time
    std::vector<std::size_t> inside;
    for (std::size_t n = 0; n < count_; ++n) {
      const double t = run_.trajectory.samples[n].time, slack = kRounding * end();
      if (t >= margin - slack && t <= end() - margin + slack) inside.push_back(n);
    }
    const std::size_t every = 1 + inside.size() / most;
    chosen_.clear();
    for (std::size_t k = 0; k < inside.size(); k += every) chosen_.push_back(inside[k]);
  }

  bool is_static() const { return !(period_ > 0); }
  double widest() const { return widest_; }  // s, the largest shift either way
  std::size_t samples() const { return chosen_.size(); }
  double end() const { return run_.trajectory.samples[count_ - 1].time; }

  Misfit at(double shift) {
    return misfit([&](double t) { run_.truth->source->at(t, shifted_.columns()); }, shift);
  }
  // Uses only the truth's samples.
  Misfit roughly_at(double shift) {
    return misfit([&](double t) { go_on_from_sample(t); }, shift);
  }

 private:
  // `find` puts the truth at an instant into shifted_.
  template <typename Find>
  Misfit misfit(const Find& find, double shift) {
    Misfit misfit;
    for (std::size_t n : chosen_) {
      const Sample& sample = run_.trajectory.samples[n];
      find(sample.time - shift);
      for_moving([&](std::size_t i, const Body& body) {
        const PoseGap gap = pose_gap(sample.bodies.columns().body(i), shifted_.columns().body(i));
        const Vec3 turned = body.inertia * gap.orientation;
        misfit.value += body.mass * gap.position.squaredNorm() + gap.orientation.dot(turned);
        // A later shift is an earlier truth.
        misfit.slope -= 2 * (body.mass * gap.position.dot(gap.position_rate) + gap.orientation_rate.dot(turned));
      });
    }
    const double share = 1.0 / static_cast<double>(chosen_.size());
    return {misfit.value * share, misfit.slope * share};
  }

  void go_on_from_sample(double t) {
    const auto& samples = run_.trajectory.samples;
    const auto steps = static_cast<std::size_t>(std::lround(std::max(0.0, t / samples[1].time)));
    const std::size_t nearest = std::min(steps, count_ - 1);
    const double after = t - samples[nearest].time;
    const BodyColumns truth = run_.truth->bodies[nearest].columns();
    for_moving([&](std::size_t i, const Body&) {
      BodyState state = truth.body(i);
      state.position += after * state.velocity;
      state.orientation = rotation_by(after * state.angular_velocity) * state.orientation;
      shifted_.columns().set_body(i, state);
    });
  }

  template <typename F>
  void for_moving(const F& f) const {
    for (std::size_t i = 0; i < run_.scene.bodies.size(); ++i) {
      if (!run_.scene.bodies[i].fixed) f(i, run_.scene.bodies[i]);
    }
  }

  // 2π √(half the mean square distance from the start / the mean square speed) is the period of a rotation about one
  // axis. It is 0.7 of the period of an oscillation that starts at its middle, and 1.2 if that starts at its end. For
  // other motions it has the right magnitude. The faster of translation and rotation counts, unless it has only 1e-9 of
  // the other's energy. 0 if nothing moves.
  void find_period() {
    double moved = 0, turned = 0, speed = 0, spin = 0, mass = 0;
    const auto truth = [&](std::size_t n) { return run_.truth->bodies[n].columns(); };
    for (std::size_t n = 0; n < count_; ++n) {
      for_moving([&](std::size_t i, const Body& body) {
        const BodyState now = truth(n).body(i);
        const PoseGap gap = pose_gap(truth(0).body(i), now);
        moved += body.mass * gap.position.squaredNorm();
        turned += gap.orientation.dot(body.inertia * gap.orientation);
        const Vec3 w_B = now.orientation.conjugate() * now.angular_velocity;
        speed += body.mass * now.velocity.squaredNorm(), spin += w_B.dot(body.inertia * w_B);
        if (n == 0) mass += body.mass;
      });
    }
    constexpr double kStill = 1e-9, kTrace = 1e-9;  // m; 1
    if (!(moved + turned > kStill * kStill * mass * static_cast<double>(count_))) return;
    const auto period = [](double square_displacement, double square_rate) {
      return 2 * std::numbers::pi * std::sqrt(0.5 * square_displacement / square_rate);
    };
    const bool moves = speed > kTrace * (speed + spin), turns = spin > kTrace * (speed + spin);
    if (moves) period_ = period(moved, speed);
    if (turns) period_ = moves ? std::min(period_, period(turned, spin)) : period(turned, spin);
  }

  const JudgedRun& run_;
  std::size_t count_;  // of the samples compared
  BodyTable shifted_;
  double period_ = 0, widest_ = 0;  // s
  std::vector<std::size_t> chosen_;
};

// Refines the best shift: the root of the slope between its neighbours, or the vertex of the parabola through the three
// misfits if the slope has no root there.
double refined(Fit& fit, std::map<int, Misfit>& tried, int best, double step, double dt) {
  const Misfit &before = tried[best - 1], &here = tried[best], &after = tried[best + 1];
  const double low = (best - 1) * step, middle = best * step, high = (best + 1) * step;
  if (!(before.slope < 0 && after.slope > 0)) {
    const double bend = before.value - 2 * here.value + after.value;
    return bend > 0 ? middle + 0.5 * step * (before.value - after.value) / bend : middle;
  }
  const double close_enough = 1e-12 * dt;  // s
  std::uintmax_t rounds = 100;
  const auto root =
      boost::math::tools::toms748_solve([&](double shift) { return fit.at(shift).slope; }, low, high, before.slope,
                                        after.slope, [&](double a, double b) { return b - a <= close_enough; }, rounds);
  return 0.5 * (root.first + root.second);
}

// From a shift down to the first that is better than both beside it, no further than `most` either way; into `tried`
// those that were asked for.
int least_beside(Fit& fit, double step, int best, int most, std::map<int, Misfit>& tried) {
  const auto value = [&](int k) {
    if (std::abs(k) > most) return std::numeric_limits<double>::infinity();
    if (!tried.contains(k)) tried[k] = fit.at(k * step);
    return tried[k].value;
  };
  while (true) {
    const int better = value(best - 1) < value(best + 1) ? best - 1 : best + 1;
    if (!(value(better) < value(best))) return best;
    best = better;
  }
}

// The best shift over all samples that it and both beside it can be compared at. Fewer can as it moves away from none.
int best_over_most_samples(Fit& fit, double step, int best, std::map<int, Misfit>& tried) {
  for (int most = std::min(std::abs(best) + 1, kEitherWay);; ++most) {
    fit.leave_out(most * step);
    tried.clear();
    best = least_beside(fit, step, best, most, tried);
    if (std::abs(best) < most || most == kEitherWay) return best;
  }
}

MetricResult measure_phase_error(const JudgedRun& run) {
  if (!run.truth || !run.truth->source) return {{}, kNoTruth};
  const std::size_t count = samples_within(run, std::min(kTruthNeededPosition, kTruthNeededOrientation));
  if (count == 0) return {{}, kNoSamples};
  Fit fit(run, count);
  if (fit.is_static()) return {{}, "the truth does not move"};
  if (fit.samples() < 3) return {{}, "there are too few samples to fit a shift to"};

  const double step = fit.widest() / kEitherWay;
  int best = 0;
  double least = fit.roughly_at(0).value;
  for (int k = -kEitherWay; k <= kEitherWay; ++k) {
    const double value = fit.roughly_at(k * step).value;
    if (value < least) best = k, least = value;
  }
  if (!std::isfinite(least)) return {{}, "the run is too far from the truth"};
  std::map<int, Misfit> tried;
  best = best_over_most_samples(fit, step, best, tried);
  if (std::abs(best) == kEitherWay) {
    return {{}, fmt::format("the best shift is {:.3g} s or more, where the search ends", fit.widest())};
  }
  Measurement out;
  out.value = refined(fit, tried, best, step, run.trajectory.dt);
  out.worst = {fit.end(), kWorld, "shift", out.value, 0};
  out.compared_until = fit.end();
  return {out, ""};
}

}  // namespace

MetricRow phase_error() {
  return {.name = "phase_error",
          .unit = "s",
          .summary = "the shift in time that fits the run best, but for the ends: it lags (+) or leads (-) the truth",
          .measure = measure_phase_error,
          .is_costly = true};
}

}  // namespace rigor::inline metric
