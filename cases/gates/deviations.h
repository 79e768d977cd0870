// Known deviations: gates that an engine is known not to meet, each with its reason. They stand beside the adapter, in
// adapters/<name>/known_deviations.toml. Such a gate may fail and the whole still holds; once it no longer fails it is
// an unexpected pass, which fails until the row goes.
#pragma once

#include <string>
#include <vector>

#include "cases/results/results.h"

namespace rigor::inline gates {

struct KnownDeviation {
  std::string case_id;
  std::string metric;         // of the gate that fails
  std::vector<RunName> runs;  // of one engine
  std::vector<StepSize> dt;   // empty: every step, and the gates over several of them
  std::string reason;
  std::string where;  // "file:line:column"
};

// Those of every known_deviations.toml in a folder of `adapters_dir`. Throws InputError, as for a case file.
std::vector<KnownDeviation> read_known_deviations(const std::string& adapters_dir,
                                                  const std::vector<EngineInfo>& engines);
std::string default_adapters_dir();

// Throws InputError for a row about one of these cases that matches none of its gates: an unused metric, run or step.
void check_known_deviations(const std::vector<KnownDeviation>& rows, const std::vector<Case>& cases,
                            const std::vector<EngineInfo>& engines);

// Turns the answers that a row speaks of from `failed` into `known_deviation` and from `held` into `unexpected_pass`,
// and cells with them. After check_gates.
void apply_known_deviations(CaseResult& result, const Results& grid, const std::vector<KnownDeviation>& rows);

}  // namespace rigor::inline gates
