#include "cases/analysis/fitting/trial_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/analysis/fitting/started_runs.h"
#include "cases/case/recording/recording.h"

namespace rigor::inline analysis {
namespace {

std::vector<std::string> caveats_of(const Profile& profile) {
  std::vector<std::string> caveats;
  const char* names[] = {"positions", "orientations"};
  for (std::size_t kind = 0; kind < profile.excess.size(); ++kind) {
    if (profile.excess[kind] > 1)
      caveats.push_back(
          fmt::format("The recorded {} are {:.3g} times as far away as their noise explains. The "
                      "intervals are that much wider, and hold for this engine alone.",
                      names[kind], profile.excess[kind]));
  }
  if (profile.wait > 1)
    caveats.push_back(
        fmt::format("Gaps last over about {:.2g} samples, so the noise is not independent or the engine "
                    "moves otherwise. The intervals are {:.2g} times wider.",
                    profile.wait, std::sqrt(profile.wait)));
  return caveats;
}

}  // namespace

TrialProfile profile_of_trials(FitProbe& probe, const FitTrials& trials, const std::vector<BoxPoint>& minima) {
  StartedRuns runs(probe, trials, minima.front().size());
  TrialProfile result;
  result.best = minima.front();
  const std::optional<BoxPoint> best = runs.fit_starts(minima.front());
  if (!best) {
    result.why_no_intervals = "No interval can be told: not every run reaches its end at the best values.";
    return result;
  }
  ProfileInput input;
  input.residuals = [&](const std::vector<Eigen::VectorXd>& points) { return runs.residuals(points); };
  input.others = runs.by_starts(), input.others_error = runs.by_starts_error(), input.kinds = runs.kinds();
  std::vector<BoxPoint> starts = minima;
  starts.front() = *best;
  for (const BoxPoint& point : starts)
    input.starts.emplace_back(Eigen::Map<const Eigen::VectorXd>(point.data(), static_cast<long>(point.size())));
  input.is_noise_estimated = std::any_of(trials.begin(), trials.end(), [&](const FitTrial& one) {
    return probe.recording_of(one.of_case)->is_noise_estimated;
  });
  const Profile profile = profile_of(input);
  result.best = BoxPoint(profile.best.data(), profile.best.data() + profile.best.size());
  if (!profile.is_told) {
    result.why_no_intervals =
        fmt::format("No interval can be told: the recording has {} numbers, which is hardly more than unknowns.",
                    input.kinds.size());
    return result;
  }
  // A linear model of the start holds near the recorded motion. Chaos, or another law, leads runs far away from it.
  constexpr double kMostExcess = 3;
  const double excess = *std::max_element(profile.excess.begin(), profile.excess.end());
  if (excess > kMostExcess) {
    result.best = minima.front();
    result.why_no_intervals = fmt::format(
        "No interval can be told: with every start near the recorded one, runs stay {:.3g} times as far away as the "
        "noise explains.",
        excess);
    return result;
  }
  result.axes = profile.axes, result.correlations = profile.correlations, result.caveats = caveats_of(profile);
  return result;
}

}  // namespace rigor::inline analysis
