// What a search for mistakes knows before it sees an engine's motion: the views, and the motions in them with each
// known mistake and without any.
#pragma once

#include <vector>

#include "cases/analysis/mistakes/ranking.h"

namespace rigor::inline analysis {

// Every mistake of adapters/faults/faults.h, without sights.
std::vector<Hypothesis> known_mistakes();

struct MistakeTable {
  std::vector<View> views;
  std::vector<Sight> bases;  // one a view: the motion without mistakes
  std::vector<Observation> observations;
  std::vector<Hypothesis> hypotheses;      // of known_mistakes()
  std::vector<std::vector<bool>> is_idle;  // by hypothesis and view: the mistake has no visible effect there

  void find_idle();
  // Two mistakes at once. Where one of them is idle, the motion is borrowed from the other.
  Hypothesis pair(std::size_t first, std::size_t second) const;
};

}  // namespace rigor::inline analysis
