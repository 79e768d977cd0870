#include "cases/metrics/measuring.h"

#include <utility>

namespace rigor {

void Course::add(double value, const Instant& instant) {
  if (measurement_.series.empty() || value > measurement_.value) {
    measurement_.value = value;
    measurement_.worst = instant;
  }
  measurement_.series.push_back(value);
  measurement_.compared_until = instant.time;
}

Measurement Course::finish() && { return std::move(measurement_); }

std::size_t samples_within(const JudgedRun& run, double needed) {
  if (!run.truth) return 0;
  std::size_t count = 0;
  while (count < run.trajectory.samples.size() && run.truth->error[count] <= needed) ++count;
  return count;
}

}  // namespace rigor
