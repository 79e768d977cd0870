// The verdict on a run in one word, and its reasons.
#pragma once

#include <string>

#include "cases/metrics/metric.h"

namespace rigor::inline metric {

// From the best to the worst; of several that apply the worst is the word, and all of them are in the sentence.
//   drifting     the energy, with the velocities brought to the positions' time, has moved away from what it should be
//                by more than 1 % of what is in play between the first and the last tenth of what can be compared;
//                likewise the energy about the centre of mass, where nothing outside holds the bodies
//   overlapping  a body overlaps a fixed one by more than the thickness of the thinner of the two, or one that moves by
//                more than half of that
//   gaining      energy that nothing drives has risen above the lowest before, at any sample, by more than 0.5 % of
//   what
//                is in play: asked where bodies can touch, and where dampers act and no truth says what they take
//   collapsed    what the truth says stands where it was built has fallen (built_at_rest.h)
//   tunnelled    two bodies have passed through each other (measures/contact/tunnelling.h)
//   blown up     see stability.h
// What is in play, and what the energy should be: energy_series.h.
enum class Verdict { stable, drifting, overlapping, gaining, collapsed, tunnelled, blown_up };
std::string word_of(Verdict verdict);         // "blown up"
Verdict verdict_of(const std::string& word);  // throws InputError for any other word

struct Stability {
  Verdict verdict = Verdict::stable;
  double time = 0;  // s: when it blew up, fell or passed; where the overlap is deepest; to where the energy has risen
  int body =
      kWorld;       // where: the first not finite or the one with the most kinetic energy, that overlaps, fell, passed
  std::string why;  // a sentence
  double amount = 0;  // drifting, gaining: a share of the energy in play; overlapping: m; else 0
};
std::string phrase_of(const Stability& stability);  // "gaining 13 %", "overlapping 0.5 m", "collapsed 0.17 s", "stable"

// Of a run that did not blow up.
Stability verdict_on(const JudgedRun& run);

}  // namespace rigor::inline metric
