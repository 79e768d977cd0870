// Where a difference enters. Both engines step once from the same state, A's, loaded afresh. Their difference after
// that step is injected there; the rest of the gap is growth of earlier differences. The same steps show what an engine
// hides: a world that runs and a world loaded in its state differ by warm starts, caches and older states.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/divergence/parting.h"
#include "cases/analysis/divergence/run_pair.h"

namespace rigor::inline analysis {

// The difference that one common step adds. Shares are of the bounds, after free motion until the runs part.
struct Injection {
  double time = 0;         // s, of the step's start
  std::size_t sample = 0;  // of its start
  int body = 0;            // with the largest share
  double share = 0;
  std::size_t alike = 0;              // other bodies that have the same share, but for 1 %
  BodyGap gap;                        // of that body, at the step's end
  double hidden_a = 0, hidden_b = 0;  // shares by which the running worlds differ from fresh ones
  int hidden_body_a = 0, hidden_body_b = 0;
};

struct Injections {
  std::vector<Injection> steps;  // by time; of all common steps, or of a selection
  bool has_all_steps = true;
  // Part of the gap at the parting that all one-step differences make by free motion. 1: the gap is injected. Much
  // less: the motion amplifies it. Beyond 1 or negative: later steps take differences back.
  double injected = 0;
  double growth = 0;         // 1/s: Lyapunov's exponent over the time until the parting, from a start nudged by 1e-8
  double growth_factor = 1;  // of a nudge, until the parting
  std::string why;           // why there are none; else empty
};

// `motion_a`, `motion_b`: samples at common steps.
Injections find_injections(const RunPair& pair, const Scene& scene, const MotionView& motion_a,
                           const MotionView& motion_b, const PartingBounds& bounds, const Parting& parting);

// The scene in A's state at these samples.
std::vector<std::shared_ptr<const Scene>> scenes_at(const Scene& scene, const MotionView& motion,
                                                    const std::vector<std::size_t>& samples, double seconds);

// The largest injections, at most `most`, none of them nearer than 5 steps to a larger one or below 1 % of the largest.
// The first of several that are alike in four digits counts as larger.
std::vector<Injection> largest_injections(const Injections& injections, std::size_t most);

}  // namespace rigor::inline analysis
