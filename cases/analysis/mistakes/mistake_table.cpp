#include "cases/analysis/mistakes/mistake_table.h"

#include "adapters/faults/faults.h"

namespace rigor::inline analysis {

std::vector<Hypothesis> known_mistakes() {
  std::vector<Hypothesis> all;
  for (const Fault& fault : faults()) all.push_back({std::make_shared<Fault>(fault), {fault.name}, {}});
  return all;
}

// Roundings are no effect. A mistake that starts each step anew makes others everywhere.
void MistakeTable::find_idle() {
  constexpr double kInvisible = 0.01;  // of the smallest distance that counts
  for (const Hypothesis& hypothesis : hypotheses) {
    std::vector<bool> idle;
    for (std::size_t v = 0; v < views.size(); ++v) {
      const Sight &base = bases[v], &moved = hypothesis.sights[v];
      idle.push_back(base.why.empty() && moved.why.empty() && base.states.size() == moved.states.size());
    }
    for (const Observation& observation : observations) {
      const std::size_t v = observation.view_index();
      const Sight& moved = hypothesis.sights[v];
      if (!(observation.distances(moved, moved).predicted <= kInvisible * observation.tolerance())) idle[v] = false;
    }
    is_idle.push_back(std::move(idle));
  }
}

Hypothesis MistakeTable::pair(std::size_t first, std::size_t second) const {
  const Hypothesis &one = hypotheses[first], &other = hypotheses[second];
  Hypothesis both{std::make_shared<Fault>(combined(*one.fault, *other.fault)), {one.names[0], other.names[0]}, {}};
  for (std::size_t v = 0; v < views.size(); ++v) {
    const bool is_one = is_idle[second][v], is_other = is_idle[first][v];
    both.sights.push_back(is_one ? one.sights[v] : is_other ? other.sights[v] : Sight{});
    if (is_one || is_other) both.sights.back().source = Sight::Source::borrowed;
  }
  return both;
}

}  // namespace rigor::inline analysis
