// For cases in which bounces magnify errors beyond any truth: no trajectory is correct, but the distribution of
// outcomes can be. A case with `ensemble = n` is run from n starts 1e-6 apart. The outcomes are compared with a
// reference's outcomes from n other starts by their energy distance (measures/energy_distance.h).
#include <fmt/format.h>

#include "cases/metrics/measures/ensembles.h"
#include "cases/metrics/metric.h"

namespace rigor::inline metric {
namespace {

MetricResult measured(const JudgedRun& run, double EnergyTest::*what, const char* component) {
  if (!run.ensembles) return {{}, "the case asks for no ensemble"};
  const Ensembles& all = *run.ensembles;
  if (!all.flaw.empty()) return {{}, all.flaw};
  Measurement out;
  out.value = all.test.*what;
  out.worst = {run.duration, kWorld, component, out.value, what == &EnergyTest::p_value ? 1.0 : 0.0};
  out.compared_until = run.duration;
  return {out, ""};
}

MetricResult measure_distance(const JudgedRun& run) { return measured(run, &EnergyTest::coefficient, "final places"); }
MetricResult measure_p_value(const JudgedRun& run) { return measured(run, &EnergyTest::p_value, "final places"); }

}  // namespace

MetricRow ensemble_distance() {
  return {.name = "ensemble_distance",
          .unit = "1",
          .summary =
              "energy distance between the final places of bodies and the reference's, for many starts 1e-6 apart: 0 "
              "equal, 1 "
              "disjoint",
          .measure = measure_distance,
          .needs = {.ensemble = true}};
}

MetricRow ensemble_p_value() {
  return {
      .name = "ensemble_p_value",
      .unit = "1",
      .summary = "probability that two ensembles of one distribution differ as much as the run's and the reference's",
      .measure = measure_p_value,
      .needs = {.ensemble = true},
      .higher_is_better = true,
      .is_compared = false};
}

}  // namespace rigor::inline metric
