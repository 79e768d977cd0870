// The verdict on a run in one word, and its reasons.
#pragma once

#include <string>

#include "cases/metrics/metric.h"

namespace rigor {

// From best to worst. If several apply, the word is the worst, and the sentence contains all of them.
//   drifting     The energy moved away from its expected value by more than 1 % of the energy in play. Compared are the
//                first and the last tenth of the comparable time, with velocities at the positions' time.
//   overlapping  A body entered a fixed one by more than its own thickness, or a moving one by more than half the
//                thickness of the thinner of the two.
//   gaining      Energy that nothing drives rose above its lowest earlier value, at any sample, by more than 0.5 % of
//                the energy in play. Checked if bodies can touch, and if dampers act and there is no truth.
//   collapsed    A structure fell that stands in its truth (built_at_rest.h).
//   blown up     see stability.h
// The energy in play and the expected energy: energy_series.h.
enum class Verdict { stable, drifting, overlapping, gaining, collapsed, blown_up };
std::string word_of(Verdict verdict);         // "blown up"
Verdict verdict_of(const std::string& word);  // throws InputError for any other word

struct Stability {
  Verdict verdict = Verdict::stable;
  double time = 0;    // s: when it blew up or fell; where the overlap is deepest; to where the energy has risen
  int body = kWorld;  // where: the first not finite or the one with the most kinetic energy, that overlaps, that fell
  std::string why;    // a sentence
  double amount = 0;  // drifting, gaining: a share of the energy in play; overlapping: m; else 0
};
std::string phrase_of(const Stability& stability);  // "gaining 13 %", "overlapping 0.5 m", "collapsed 0.17 s", "stable"

// Of a run that did not blow up.
Stability verdict_on(const JudgedRun& run);

}  // namespace rigor
