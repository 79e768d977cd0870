#include "cases/case/selection.h"

#include <algorithm>

namespace rigor::inline cases {

bool is_same_run(const RunName& a, const RunName& b) {
  return a.engine == b.engine && a.settings.method == b.settings.method && a.settings.options == b.settings.options &&
         a.settings.track == b.settings.track;
}

GateSelection::GateSelection(const Gate& gate, const std::vector<EngineInfo>& engines) : dt_(gate.dt) {
  for (const std::string& name : gate.engines) runs_.push_back(parse_run_name(name, engines));
  if (const RankingLimit* ranking = gate.ranking()) better_than_ = parse_run_name(ranking->better_than, engines);
}

bool GateSelection::takes(const RunName& run) const {
  return runs_.empty() ||
         std::any_of(runs_.begin(), runs_.end(), [&](const RunName& own) { return is_same_run(own, run); });
}

bool GateSelection::needs(const RunName& run) const {
  return takes(run) || (better_than_ && is_same_run(*better_than_, run));
}

bool GateSelection::takes(const StepSize& dt) const {
  return dt_.empty() || std::find(dt_.begin(), dt_.end(), dt) != dt_.end();
}

std::vector<std::string> runs_named_by(const Gate& gate) {
  std::vector<std::string> names = gate.engines;
  if (const RankingLimit* ranking = gate.ranking()) names.push_back(ranking->better_than);
  return names;
}

bool is_judged(const Case& definition, const RunName& run, const StepSize& dt, const std::vector<EngineInfo>& engines) {
  return std::any_of(definition.gates.begin(), definition.gates.end(), [&](const Gate& gate) {
    const GateSelection selection(gate, engines);
    return selection.needs(run) && selection.takes(dt);
  });
}

}  // namespace rigor::inline cases
