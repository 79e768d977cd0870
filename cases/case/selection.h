// The cells of a case that a gate judges: its engines and step sizes, or all if it names none.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/case/case.h"
#include "core/engine/run_name.h"

namespace rigor::inline cases {

// The same engine, method, options and track, however written.
bool is_same_run(const RunName& a, const RunName& b);

class GateSelection {
 public:
  GateSelection(const Gate& gate, const std::vector<EngineInfo>& engines);
  bool takes(const RunName& run) const;
  bool takes(const StepSize& dt) const;
  // Whether the gate cannot be answered without this run: it judges it, or holds others against it.
  bool needs(const RunName& run) const;

 private:
  std::vector<RunName> runs_;
  std::optional<RunName> better_than_;
  std::vector<StepSize> dt_;
};

// The runs that a gate names, to judge them or to hold others against them.
std::vector<std::string> runs_named_by(const Gate& gate);

// Whether a gate of the case needs this cell.
bool is_judged(const Case& definition, const RunName& run, const StepSize& dt, const std::vector<EngineInfo>& engines);

}  // namespace rigor::inline cases
