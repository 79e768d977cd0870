#include "cases/metrics/measures/measuring.h"

#include <algorithm>
#include <utility>

namespace rigor::inline metric {
namespace {

// At the start every run equals the scene. A comparison only there would find no error in any run.
std::size_t beyond_the_start(std::size_t count, const JudgedRun& run) {
  return count == 1 && run.trajectory.samples.size() > 1 ? 0 : count;
}

}  // namespace

void TimeSeries::add(double value, const Instant& instant) {
  if (measurement_.series.empty() || value > measurement_.value) {
    measurement_.value = value;
    measurement_.worst = instant;
  }
  measurement_.series.push_back(value);
  measurement_.compared_until = instant.time;
}

Measurement TimeSeries::finish() && { return std::move(measurement_); }

std::size_t samples_within(const JudgedRun& run, double needed) {
  if (!run.truth) return 0;
  std::size_t count = 0;
  while (count < run.trajectory.samples.size() && run.truth->error[count] <= needed) ++count;
  return beyond_the_start(count, run);
}

std::vector<double> motion_extents(const Trajectory& trajectory) {
  std::vector<double> extents;
  double extent = 0;
  for (const Sample& sample : trajectory.samples) {
    const BodyColumns bodies = sample.bodies.columns();
    for (std::size_t i = 0; i < bodies.size(); ++i) extent = std::max(extent, bodies.position(i).norm());
    extents.push_back(extent);
  }
  return extents;
}

std::size_t samples_with_twin(const JudgedRun& run, const std::vector<double>& rounding,
                              const std::vector<double>& scale, double needed_of_truth) {
  std::size_t count = std::min(run.trajectory.samples.size(), rounding.size());
  if (run.truth) count = std::min(count, samples_within(run, needed_of_truth));
  std::size_t n = 0;
  while (n < count && rounding[n] <= kRoundingShare * scale[n]) ++n;
  return beyond_the_start(n, run);
}

}  // namespace rigor::inline metric
