#include "cases/analysis/fitting/fitting.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "cases/analysis/fitting/bootstrap.h"
#include "cases/analysis/fitting/fit_probe.h"
#include "cases/analysis/fitting/trial_profile.h"
#include "cases/case/recording/recording.h"
#include "core/base/error.h"

namespace rigor::inline analysis {
namespace {

constexpr std::size_t kStarts = 3;
// Values on each axis in a search from one of the starts, and as many in one that goes on from its end.
constexpr std::size_t kMostValues = 20;
constexpr double kApart = 0.2;     // of starts: beyond the first simplex of another
constexpr double kRough = 1e-2;    // of a range: how near to a minimum a search from one of the starts goes
constexpr double kAtBound = 1e-3;  // of a range: nearer to its end a minimum cannot be told from one beyond it
constexpr double kDegrees = 57.29577951308232;

constexpr const char* kChangesNothing = "it changes nothing here";

using Errors = std::vector<TrialError>;

double mean_of(const std::vector<double>& values) {
  double sum = 0;
  for (const double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double deviation_of(const std::vector<double>& values) {
  if (values.size() < 2) return 0;
  const double mean = mean_of(values);
  double squares = 0;
  for (const double value : values) squares += (value - mean) * (value - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

// A run without result is as far off as a run can be: the median of such a trial ranks behind all others.
double median_square(const Errors& errors) {
  std::vector<double> squares;
  for (const TrialError& one : errors) squares.push_back(one.has_result() ? one.square : HUGE_VAL);
  const auto middle = squares.begin() + static_cast<long>(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return *middle;
}

// The smoothed loss of Huber: the square of a usual trial's error, and nearly the error itself of one that is far off.
class TrialLoss {
 public:
  // `usual`: the square of a usual trial, or 1, which noise alone makes.
  explicit TrialLoss(double usual) : scale_(std::max(1.0, usual)) {}

  double of(const TrialError& error) const {
    constexpr double kLost = 1e4;  // usual errors, squared, for a run without result
    const double share = error.has_result() ? error.square / scale_ : kLost;
    return 2 * (std::sqrt(1 + share) - 1);
  }
  std::vector<double> of(const Errors& errors) const {
    std::vector<double> losses;
    for (const TrialError& one : errors) losses.push_back(of(one));
    return losses;
  }

 private:
  double scale_;
};

// Trials that take part, and those held out.
struct Split {
  FitTrials training, held_out;
};

Split split_of(FitTrials trials, double share, unsigned long seed) {
  const auto count = static_cast<std::size_t>(std::lround(share * static_cast<double>(trials.size())));
  std::mt19937_64 random(seed);
  for (std::size_t i = trials.size(); i > 1; --i) std::swap(trials[i - 1], trials[random() % i]);
  const auto middle = trials.begin() + static_cast<long>(count);
  Split split{{middle, trials.end()}, {trials.begin(), middle}};
  const auto by_place = [](const FitTrial& a, const FitTrial& b) {
    return std::pair(a.of_case, a.trial) < std::pair(b.of_case, b.trial);
  };
  std::sort(split.training.begin(), split.training.end(), by_place);
  std::sort(split.held_out.begin(), split.held_out.end(), by_place);
  return split;
}

FitErrors summary_of(const Errors& errors, const FitTrials& trials, const FitProbe& probe) {
  FitErrors summary;
  summary.is_percent = std::all_of(trials.begin(), trials.end(), [&](const FitTrial& one) {
    const MotionRecording* recording = probe.recording_of(one.of_case);
    return recording && recording->length > 0;
  });
  std::vector<double> positions, rotations;
  for (std::size_t t = 0; t < trials.size(); ++t) {
    if (!errors[t].has_result()) {
      ++summary.without_result;
      continue;
    }
    const double unit = summary.is_percent ? 100 / probe.recording_of(trials[t].of_case)->length : 1;
    if (!std::isnan(errors[t].position)) positions.push_back(unit * errors[t].position);
    if (!std::isnan(errors[t].rotation)) rotations.push_back(kDegrees * errors[t].rotation);
  }
  summary.trials = trials.size();
  summary.position = positions.empty() ? TrialError::kNone : mean_of(positions);
  summary.rotation = rotations.empty() ? TrialError::kNone : mean_of(rotations);
  summary.position_spread = deviation_of(positions), summary.rotation_spread = deviation_of(rotations);
  return summary;
}

class Fitting {
 public:
  Fitting(const FitInput& input, const EngineTable& engines, const Vocabulary& vocabulary)
      : input_(input),
        probe_(input, engines, vocabulary),
        split_(split_of(probe_.all_trials(), input.hold_out, input.seed)) {
    if (split_.training.empty() || (input.hold_out > 0 && split_.held_out.empty()))
      throw InputError(
          fmt::format("--hold-out: found {}, which leaves one side of {} trials empty; allowed: a share "
                      "that leaves trials on both sides",
                      input.hold_out, probe_.all_trials().size()));
  }

  FitResult run() {
    BoxMinimum best = searched();
    FitResult fit;
    std::optional<TrialProfile> profile;
    if (has_profile()) profile = profile_of_trials(probe_, split_.training, minima_), best.at = profile->best;
    for (std::size_t i = 0; i < input_.axes.size(); ++i) fit.parameters.push_back(parameter_at(best.at, i));
    if (profile) {
      tell_profile(*profile, fit);
    } else {
      tell_bootstrap(best, fit);
    }
    fit.training = errors_on(best.at, split_.training);
    if (!split_.held_out.empty()) fit.held_out = errors_on(best.at, split_.held_out);
    fit.points = probe_.points();
    return fit;
  }

 private:
  Errors errors_at(const BoxPoint& point) { return probe_.errors({point}, split_.training).front(); }

  FitErrors errors_on(const BoxPoint& point, const FitTrials& trials) {
    return summary_of(probe_.errors({point}, trials).front(), trials, probe_);
  }

  BoxMinimum searched() {
    const std::size_t axes = input_.axes.size();
    const std::vector<BoxPoint> points = latin_hypercube(10 * axes + 6, axes, input_.seed);
    const auto errors = probe_.errors(points, split_.training);
    double usual = HUGE_VAL;
    for (const Errors& one : errors) usual = std::min(usual, median_square(one));
    if (!std::isfinite(usual))
      throw InputError(
          fmt::format("{}: at none of {} points do most of the runs reach their end; give other ranges, "
                      "or look at one run by rigor trace",
                      input_.run.text, points.size()));
    loss_ = TrialLoss(usual);
    std::vector<BoxMinimum> tried;
    for (std::size_t p = 0; p < points.size(); ++p) tried.push_back({points[p], mean_of(loss_.of(errors[p]))});
    const std::function<double(const BoxPoint&)> function = [&](const BoxPoint& point) {
      return mean_of(loss_.of(errors_at(point)));
    };
    std::vector<BoxMinimum> rough;
    for (const BoxMinimum& start : distinct_starts(tried, kStarts, kApart))
      rough.push_back(nelder_mead(function, start, {0.1, kRough, kMostValues * axes}));
    rough = distinct_starts(std::move(rough), kStarts, 0);
    for (const BoxMinimum& one : rough) minima_.push_back(one.at);
    // The profile's own search goes on from a rough minimum.
    return has_profile() ? rough.front() : refined(rough, function);
  }

  // Searches on from the best of these minima, and from others nearly as good, of which one may turn out the better.
  static BoxMinimum refined(const std::vector<BoxMinimum>& rough,
                            const std::function<double(const BoxPoint&)>& function) {
    constexpr double kNearly = 0.05;  // of a usual trial's loss: ten times what a rough minimum is off by
    BoxMinimum best = rough.front();
    for (const BoxMinimum& one : distinct_starts(rough, kStarts, 3 * kRough)) {
      if (one.value > rough.front().value + kNearly) continue;
      const BoxMinimum found = nelder_mead(function, one, {2 * kRough, 1e-4, kMostValues * one.at.size()});
      if (found.value < best.value) best = found;
    }
    return best;
  }

  FittedParameter parameter_at(const BoxPoint& point, std::size_t i) const {
    FittedParameter parameter;
    parameter.key = input_.axes[i].key, parameter.unit = unit_of_axis(input_.axes[i]);
    parameter.value = probe_.values_at(point)[i], parameter.number = number_in(parameter.value);
    parameter.is_at_bound = point[i] < kAtBound || point[i] > 1 - kAtBound;
    return parameter;
  }

  double number_at(BoxPoint point, std::size_t i, double share) const {
    point[i] = share;
    return number_in(probe_.values_at(point)[i]);
  }

  bool has_profile() const {
    if (split_.training.size() >= kFewestTrials) return false;
    return std::all_of(split_.training.begin(), split_.training.end(),
                       [&](const FitTrial& one) { return probe_.recording_of(one.of_case) != nullptr; });
  }

  void tell(const BoxPoint& best, std::size_t i, const ProfileAxis& axis, FittedParameter& parameter) const {
    parameter.interval = {number_at(best, i, axis.low), number_at(best, i, axis.high)};
    parameter.is_low_open = axis.is_low_open, parameter.is_high_open = axis.is_high_open;
  }

  void tell_profile(const TrialProfile& profile, FitResult& fit) {
    fit.caveats = profile.caveats, fit.correlations = profile.correlations;
    fit.why_no_intervals = profile.why_no_intervals;
    if (fit.why_no_intervals.empty()) fit.method = "profile";
    for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
      FittedParameter& parameter = fit.parameters[i];
      if (changes_nothing(profile.best, i)) parameter.unknown = kChangesNothing;
      if (profile.axes.empty() || !parameter.unknown.empty()) continue;
      const ProfileAxis& axis = profile.axes[i];
      if (axis.is_low_open && axis.is_high_open) {
        parameter.unknown = "no value of its range is unlikely";
      } else {
        tell(profile.best, i, axis, parameter);
      }
    }
  }

  void tell_bootstrap(const BoxMinimum& best, FitResult& fit) {
    for (std::size_t i = 0; i < fit.parameters.size(); ++i) fit.parameters[i].unknown = why_unknown(best.at, i);
    if (split_.training.size() < kFewestTrials) {
      fit.why_no_intervals = fmt::format(
          "No interval can be told: a computed truth has no noise, {} trial{} took part, and a bootstrap needs {}.",
          split_.training.size(), split_.training.size() == 1 ? "" : "s", kFewestTrials);
      return;
    }
    const Bootstrap bootstrap = bootstrap_around(
        best.at,
        [&](const std::vector<BoxPoint>& points) {
          std::vector<std::vector<double>> losses;
          for (const Errors& one : probe_.errors(points, split_.training)) losses.push_back(loss_.of(one));
          return losses;
        },
        input_.seed);
    for (std::size_t i = 0; i < fit.parameters.size(); ++i) {
      FittedParameter& parameter = fit.parameters[i];
      const BootstrapAxis& axis = bootstrap.axes[i];
      constexpr double kWhole = 0.9;  // of the range
      // An end of the range fits worse, as why_unknown() has seen, so the parabolas have failed.
      if (parameter.unknown.empty() && (!axis.is_curved || axis.high - axis.low > kWhole))
        parameter.unknown = "the loss near it tells no interval";
      if (parameter.unknown.empty()) tell(best.at, i, {axis.low, axis.high, axis.low <= 0, axis.high >= 1}, parameter);
    }
    fit.method = "bootstrap", fit.correlations = bootstrap.correlations;
  }

  // Whether both ends of the range give the very errors of the best value.
  bool changes_nothing(const BoxPoint& best, std::size_t i) {
    const auto losses = losses_at_ends(best, i);
    return losses[1] == losses[0] && losses[2] == losses[0];
  }

  std::vector<std::vector<double>> losses_at_ends(const BoxPoint& best, std::size_t i) {
    BoxPoint low = best, high = best;
    low[i] = 0, high[i] = 1;
    std::vector<std::vector<double>> losses;
    for (const Errors& one : probe_.errors({best, low, high}, split_.training)) losses.push_back(loss_.of(one));
    return losses;
  }

  // The ends of the range, with all else as fitted. An end that fits as well, as far as the trials can tell, says that
  // they know no value.
  std::string why_unknown(const BoxPoint& best, std::size_t i) {
    const auto losses = losses_at_ends(best, i);
    const auto &at_best = losses[0], &at_low = losses[1], &at_high = losses[2];
    if (at_low == at_best && at_high == at_best) return kChangesNothing;
    if (is_as_good(at_low, at_best) && is_as_good(at_high, at_best)) return "both ends of the range fit as well";
    return "";
  }

  // Whether the mean difference is within twice its standard error. A single trial has none: there a difference of 1 %
  // counts.
  static bool is_as_good(const std::vector<double>& end, const std::vector<double>& best) {
    std::vector<double> differences;
    for (std::size_t t = 0; t < end.size(); ++t) differences.push_back(end[t] - best[t]);
    const double mean = mean_of(differences);
    constexpr double kNoSign = 1e-6;  // of the loss: less is no sign of a better fit, even if all trials agree
    if (mean <= kNoSign * mean_of(best)) return true;
    if (differences.size() < kFewestTrials) return mean <= 0.01 * mean_of(best);
    return mean <= 2 * deviation_of(differences) / std::sqrt(static_cast<double>(differences.size()));
  }

  const FitInput& input_;
  FitProbe probe_;
  Split split_;
  TrialLoss loss_{1};
  std::vector<BoxPoint> minima_;  // of all searches
};

void check_axes(const FitInput& input) {
  for (const SweepAxis& axis : input.axes) {
    if (axis.kind == SweepAxis::Kind::length)
      throw InputError("--vary: the duration of a run cannot be fitted; give another key");
    if (!axis.is_range)
      throw InputError(
          fmt::format("--vary {}: found a list of values; allowed: a range, as {}=0.1..0.9", axis.key, axis.key));
  }
}

}  // namespace

FitResult fit(const FitInput& input, const EngineTable& engines, const Vocabulary& vocabulary) {
  check_axes(input);
  return Fitting(input, engines, vocabulary).run();
}

}  // namespace rigor::inline analysis
