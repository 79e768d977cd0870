// Many runs of one case from starts 1e-6 m and 1e-6 m/s apart, drawn by a seed of their own.
#pragma once

#include <optional>

#include "adapters/engines.h"
#include "cases/case/case.h"
#include "cases/metrics/measures/ensembles.h"
#include "core/engine/run_name.h"

namespace rigor::inline runner {

inline constexpr double kJitter = 1e-6;  // m and m/s, along each axis at most
inline constexpr int kPermutations = 999;

// The starts of the case moved by numbers of this seed; only bodies that can move.
Scene jittered(const Scene& scene, std::uint64_t seed);

// The final positions of the moving bodies, one point per start. Empty, with the reason in `flaw`, if a run is not
// finite to the end or breaks its method's promise.
std::optional<Points> outcomes_of(const Engine& engine, const Settings& settings, const Case& definition, double dt,
                                  std::uint64_t first_seed, std::string& flaw);

// The core's own outcomes at the case's finest step, compared with another ensemble at half of that step. If these two
// differ, outcomes still depend on the step, and no run can be judged.
class EnsembleReference {
 public:
  EnsembleReference(const EngineTable& engines, const Case& definition);
  Ensembles compare(const EngineTable& engines, const RunName& run, const Case& definition, double dt) const;

 private:
  std::optional<Points> outcomes_;
  std::string flaw_;
};

// "64 starts: 128 runs of a reference and 64 in each of 6 cells"; empty for a case without ensembles.
std::string cost_of_ensemble(const Case& definition, std::size_t cells);

}  // namespace rigor::inline runner
