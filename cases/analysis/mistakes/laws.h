// Conservation laws that a scheme may keep to rounding whatever its step. A drift that shrinks with the step is either
// the scheme's own or that of a mistake which vanishes with the step: the motion extrapolated to a step of nothing
// shows neither.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cases/analysis/mistakes/motions.h"
#include "cases/analysis/mistakes/probes.h"

namespace rigor::inline analysis {

struct LawDrift {
  std::string law = "";   // "linear momentum", "angular momentum"
  std::size_t cases = 0;  // where the law holds and the engine was seen
  bool is_kept = true;    // to rounding in all of them
  std::string id = "";    // the case with the largest drift
  double dt = 0;          // s, there
  double drift = 0;       // there, as a share of the momentum in the motion
  double at_half_dt = 0;  // the same at half the step
  bool has_twin = false;  // the engine's twin repeats this case, so a drift of the scheme is in both
};

// The laws that hold in a scene, of those above:
// - linear momentum of all bodies, less what gravity gives, without forces from outside;
// - angular momentum of each body about its centre, if nothing acts on it but gravity.
std::vector<std::string> laws_of(const Scene& scene);

// Gathers the drifts of one engine.
class LawWatch {
 public:
  explicit LawWatch(bool is_single) : is_single_(is_single) {}
  // The motions at the probe's step, each sample kept, and at half of it, each second sample kept.
  void add(const ProbeScene& probe, const StateSeries& motion, const StateSeries& at_half_dt);
  std::vector<LawDrift> drifts() const;

 private:
  bool is_single_;
  std::map<std::string, LawDrift> drifts_;
};

}  // namespace rigor::inline analysis
