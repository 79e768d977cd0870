#include "cases/gates/quick.h"

#include <fmt/format.h>

#include <algorithm>

#include "cases/case/selection.h"
#include "core/base/error.h"

namespace rigor::inline gates {
namespace {

bool is_quick(const Case& definition, const StepSize& dt) {
  const double steps = definition.duration / dt.seconds;
  return steps * static_cast<double>(definition.scene.bodies.size()) <= kQuickBodySteps * (1 + 1e-9);
}

// Leaves the gate's quick steps. False if the gate cannot be answered by them.
bool narrow(Gate& gate, const Case& definition, const std::vector<EngineInfo>& engines) {
  const GateSelection selection(gate, engines);
  std::vector<StepSize> quick;
  bool all_are_quick = true;
  for (const StepSize& dt : definition.dt) {
    if (!selection.takes(dt)) continue;
    if (is_quick(definition, dt)) quick.push_back(dt);
    all_are_quick &= is_quick(definition, dt);
  }
  const bool is_over_several = gate.order() || gate.metric == "observed_order";
  gate.dt = quick;
  return is_over_several ? all_are_quick : !quick.empty();
}

}  // namespace

std::vector<Case> quick_selection(const std::vector<Case>& cases, const std::vector<EngineInfo>& engines) {
  std::vector<Case> selected;
  for (Case definition : cases) {
    std::erase_if(definition.gates, [&](Gate& gate) { return !narrow(gate, definition, engines); });
    if (!definition.gates.empty()) selected.push_back(std::move(definition));
  }
  if (selected.empty())
    throw InputError("--quick: no gate of the selection is quick; leave it out, or take other cases");
  return selected;
}

}  // namespace rigor::inline gates
