// Metrics that compare a run with a truth from the same code. Such a comparison is no witness.
#pragma once

#include <string>

#include "cases/case/case.h"
#include "core/engine/run_name.h"
#include "core/scene/scene.h"

namespace rigor::inline metric {

// Whether a metric takes its expected value from the truth, always or in some scenes. An unknown metric does.
bool is_against_truth(const std::string& metric);

// Whether a run is compared with itself, when this metric judges it against this truth or a reference's ensemble.
bool is_held_to_itself(const std::string& truth, const std::string& metric, const RunName& run, const Scene& scene);
// The same of a case, whose truth may be a synthetic recording that the run's engine made.
bool is_case_held_to_itself(const Case& definition, const std::string& metric, const RunName& run);

}  // namespace rigor::inline metric
