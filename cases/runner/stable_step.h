// The search for the largest step at which an engine's run does not blow up, and its method does what it promises: a
// run of which World::solver_warning() says otherwise is invalid, and no step to recommend.
#pragma once

#include "cases/results/results.h"

namespace rigor::inline runner {

// Over `horizon` seconds, to 1 % by bisection in log dt. The limit is ragged: steps above the first bad one may hold
// again by luck. So it is the largest below which none tried is bad, steps being tried 3 % apart, or 20 % (and bisected
// to 5 %) among bodies that touch or are jointed and have no springs, over a factor of two below it.
// `energy_in_play`: J, see judge_stability.
//
// A search takes no more than some 10 million steps of one body; in a jointed scene 0.4 million, a joint
// counting as thirty, one with limits as three hundred, and n joints that close loops as n³/16 more. Where trying so
// many steps would take half of what is left, the limit is found by bisection alone; where all is used up, the search
// ends with the last step known to hold (is_cap), or known not to (is_floor). Of a method that divides its own steps
// (MethodInfo::adaptive) the largest step and its halves alone are tried in a jointed scene. StableStep::cut says so.
// It counts steps and no time: a search finds the same wherever it runs.
StableStep largest_stable_dt(const Engine& engine, const Settings& settings, const Scene& scene, double horizon,
                             double energy_in_play);

// Lowers a case's largest stable steps to where its own cells hold. A search looks at the steps within a factor of two
// below its answer, and a run may blow up at a finer one. Then the answer is the largest step of a cell below all those
// that blew up, tunnelled or were invalid.
void hold_to_cells(CaseResult& result);

}  // namespace rigor::inline runner
