// Finds the cheapest setting of an engine that keeps bounds on several cases. The space is the engine's methods, the
// option values in their tables, and steps. Options without effect are left out. Short runs compare the settings first,
// and the better half goes on to longer runs (successive halving: Jamieson, Talwalkar, AISTATS 2016). The rest run in
// full. The cheapest of them are measured several times. If none of them keeps the bounds, numbers between the tried
// values are searched.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/tuning/bound.h"
#include "cases/results/results.h"

namespace rigor::inline analysis {

struct TuneOptions {
  int jobs = 1;
  double limit = 60;                                   // s of CPU time for each cell and each truth
  unsigned long seed = 1;                              // of the combinations drawn if there are too many
  std::size_t settings = 48;                           // the most combinations of methods and options
  bool refines = true;                                 // search between tried values if none of them keeps the bounds
  std::function<void(std::size_t runs)> on_runs = {};  // called with the number of finished runs, each a case at a step
};

// A full run at one step on all cases.
struct TunedPoint {
  RunName run;
  StepSize dt{0, ""};
  double error = 0;            // the largest value/bound over bounds and cases; at most 1 if all bounds are kept
  double cost = 0;             // s of CPU time per simulated second, summed over the cases; the median of repeats
  double least = 0, most = 0;  // of the repeats
  std::string why;             // the reason if there is no result; else empty
  bool keeps() const { return why.empty() && error <= 1; }
};

struct Tuning {
  std::string engine;
  std::optional<TunedPoint> winner;
  std::vector<TunedPoint> ties;             // repeats cannot tell these from the winner
  std::vector<TunedPoint> front;            // no other point is both cheaper and more accurate; by cost
  std::vector<std::string> without_effect;  // "worldstep: erp"
  std::vector<std::string> remarks;         // parts of runs that no bound was compared with
  bool is_refined = false;                  // only numbers between the tried ones keep the bounds
  std::string nearest;                      // if nothing keeps the bounds: the nearest point, or why nothing ran
  std::size_t settings = 0, runs = 0;       // tried
};

// `points` keep the bounds. Returns those whose repeats overlap with the cheapest one's, the winner first. The winner
// has the fewest options, then the longest step, then the first name.
std::vector<TunedPoint> equally_cheap(std::vector<TunedPoint> points);

// The steps that are tried: 1/10 to 1/10000 s.
const std::vector<StepSize>& tuned_steps();

// `text` names an engine or one of its methods, with fixed options and a fixed track.
Tuning tune(const std::string& text, const std::vector<Case>& cases, const std::vector<Bound>& bounds,
            const EngineTable& engines, const TuneOptions& options);

}  // namespace rigor::inline analysis
