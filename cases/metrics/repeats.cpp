// Whether the run gives the same bits when its scene is loaded and stepped again in the same process: 1, or 0 from the
// first number that differs. It doubles the work of a cell, so it is measured only if a gate names it.
#include <algorithm>
#include <cstring>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {
namespace {

bool have_same_bits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

// The first number that differs; none if all have the same bits.
std::optional<Instant> first_other(const Sample& one, const Sample& other) {
  const BodyColumns a = one.bodies.columns(), b = other.bodies.columns();
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t c = 0; c < kColumnNames.size(); ++c) {
      const double found = b.column(static_cast<int>(c))[i], due = a.column(static_cast<int>(c))[i];
      if (!have_same_bits(found, due)) return Instant{one.time, static_cast<int>(i), kColumnNames[c], found, due};
    }
  }
  return {};
}

MetricResult measure_repeats(const JudgedRun& run) {
  if (!run.again) return {{}, "not measured: the run is long, and no gate asks for it"};
  const std::vector<Sample>&samples = run.trajectory.samples, &again = run.again->samples;
  if (samples.empty()) return {{}, "the run has no finite step"};
  Measurement out;
  out.value = 1;
  out.compared_until = samples.back().time;
  out.worst = {samples.back().time, kWorld, "samples", static_cast<double>(again.size()),
               static_cast<double>(samples.size())};
  if (again.size() != samples.size()) out.value = 0;
  for (std::size_t n = 0; n < std::min(samples.size(), again.size()); ++n) {
    const std::optional<Instant> other = first_other(samples[n], again[n]);
    if (!other) continue;
    out.value = 0, out.worst = *other;
    break;
  }
  return {out, ""};
}

}  // namespace

MetricRow repeats() {
  return {.name = "repeats",
          .unit = "1",
          .summary = "1 if the run gives the same bits when it is loaded and stepped again, else 0",
          .measure = measure_repeats,
          .needs = {},
          .higher_is_better = true,
          .is_costly = true};
}

}  // namespace rigor::inline metric
