// Why two engines differ after one step from one state. Each part of the scene is taken away in turn; the named part
// takes at least half of the difference with it. Half the step tells whether the difference is one of the schemes'
// order: it then falls with dt.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/divergence/injections.h"

namespace rigor::inline analysis {

struct Evidence {
  std::string what, detail;  // as in Ablation
  double share = 0;          // of the difference, that vanishes with the part; negative if it grows
  int rank = 0;
  bool is_general = false;
};

struct Cause {
  Injection at;
  std::vector<Evidence> evidence;  // by share
  std::string what, detail;        // the part that is named; empty if none takes half of the difference with it
  double share = 0;
  // The difference after the same time in steps of half the length, as a share. An order p of the schemes makes it
  // 2^-p. 1 or more: it does not fall with dt.
  double at_half_step = 1;
  bool is_measured_at_half_step = false;
  double roundings = 0;      // the difference, in roundings of the engine with the lesser precision
  bool is_rounding = false;  // it is no larger than some roundings
  std::string why;           // why nothing could be found; else empty

  bool falls_with_dt() const { return is_measured_at_half_step && at_half_step < kFalls; }
  // Halfway, in powers of 2, between a difference of first order and one that does not fall.
  static constexpr double kFalls = 0.70710678118654752;
};

std::vector<Cause> find_causes(const RunPair& pair, const Scene& scene, const MotionView& motion_a,
                               const PartingBounds& bounds, const Parting& parting,
                               const std::vector<Injection>& injections);

}  // namespace rigor::inline analysis
