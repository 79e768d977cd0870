// The cheapest setting of an engine that keeps bounds on all of some cases. The space is the engine's methods, values
// of the options in their tables, and steps; what an option does not change is left out of it. Settings are held to the
// bounds on shortened runs first, of which the better half goes on to longer ones (successive halving: Jamieson,
// Talwalkar, AISTATS 2016); those left are run in full, and what is cheapest there is measured again and again.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/tuning/bound.h"
#include "cases/results/results.h"

namespace rigor {

struct TuneOptions {
  int jobs = 1;
  double limit = 60;          // s of CPU time for each cell and each truth
  unsigned long seed = 1;     // of what is drawn where the options' values are too many
  std::size_t settings = 48;  // of methods and options, at most
};

// A run at a step, in full on all cases.
struct TunedPoint {
  RunName run;
  StepSize dt{0, ""};
  double error = 0;            // the largest of value/bound, over bounds and cases: up to 1 keeps them all
  double cost = 0;             // s of CPU of a simulated second, summed over the cases: the median of its repeats
  double least = 0, most = 0;  // of the repeats
  std::string why;             // why it has no result; empty if it has one
  bool keeps() const { return why.empty() && error <= 1; }
};

struct Tuning {
  std::string engine;
  std::optional<TunedPoint> winner;
  std::vector<TunedPoint> ties;             // what costs the same as the winner, as far as repeats can tell
  std::vector<TunedPoint> front;            // no other is both cheaper and more right; by cost
  std::vector<std::string> without_effect;  // "worldstep: erp"
  std::vector<std::string> remarks;         // what the bounds were not held to
  std::string nearest;                      // where nothing keeps the bounds: what came nearest, or why nothing ran
  std::size_t settings = 0, runs = 0;       // tried
};

// The steps that are tried: 1/10 to 1/10000 s.
const std::vector<StepSize>& tuned_steps();

// `text` names an engine, or one of its methods, with the options and the track that are not to be changed.
Tuning tune(const std::string& text, const std::vector<Case>& cases, const std::vector<Bound>& bounds,
            const EngineTable& engines, const TuneOptions& options);

}  // namespace rigor
