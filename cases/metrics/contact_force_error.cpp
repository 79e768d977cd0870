// The difference between the contact force that an engine reports for a pair and the one that the truth's motion
// implies, in the directions in which the equations of motion determine it (equilibrium.h). Both are means over a step.
#include "cases/metrics/measures/contact/pair_differences.h"

namespace rigor::inline metric {
namespace {

MetricResult measure_force_error(const JudgedRun& run) {
  if (const std::string why = why_no_pairs(run); !why.empty()) return {{}, why};
  return largest_pair_difference(run, "force", &DueWrench::force_counts, [](const PairAtStep& at) {
    const Vec3 found = at.due.force_counts * at.found.force, due = at.due.force_counts * at.due.wrench.force;
    return std::optional(PairDifference{(found - due).norm(), found.norm(), due.norm()});
  });
}

}  // namespace

MetricRow contact_force_error() {
  return {.name = "contact_force_error",
          .unit = "N",
          .summary = "largest difference of a pair's reported contact force from that which the truth's motion implies",
          .measure = measure_force_error,
          .needs = {.truth = true, .contacts = true}};
}

}  // namespace rigor::inline metric
