// Views compare an engine's motion on a probe with the motion of a known mistake. The error of the engine's scheme must
// have no share in the comparison. There are four kinds:
// - twin: the base is the engine's scheme replica (twin), which has the same scheme error to rounding.
// - extrapolated: motions at three step sizes are extrapolated to dt = 0. The base is the accurate core. A mistake that
//   vanishes with dt is not visible.
// - same_method: the base is a method of the core that steps points as the engine does. It shows mistakes that depend
// on
//   the step.
// - accurate: the base is the accurate core, without extrapolation, for methods of high order and for contacts.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/mistakes/motions.h"
#include "cases/analysis/mistakes/probes.h"
#include "core/engine/run_name.h"

namespace rigor::inline analysis {

struct View {
  enum class Kind { twin, extrapolated, same_method, accurate } kind;
  std::size_t probe;
  RunName base;            // of the core
  std::vector<double> dt;  // s, one, or three that halve
  long steps, every;       // of the first dt
  int order = 1;           // of the engine's method, by which three are extrapolated
  double tolerance = 0;    // the smallest distance that counts in this kind of view, scaled
  bool can_touch = false;  // an engine may meet an impact up to a step too late
};

// One motion as a view shows it.
struct Sight {
  std::vector<double> states;  // as StateSeries's
  // The same with less certainty, to measure it. Extrapolated: from the two finer steps alone. Beside a twin: the
  // motion after a nudge by some roundings (nudged_tasks). Else empty.
  std::vector<double> coarse;
  std::string why = "not simulated";  // the reason if there is no motion; else empty
  bool as_loaded_alone = false;       // of a mistake: only its state as loaded is compared
  // borrowed: of two mistakes, the motion of one, because the other alone has no effect in the view.
  enum class Source { none, simulated, borrowed } source = Source::none;
};

// The views of a run on the probes. `of_points`: the base of Kind::same_method; null if it is not needed.
std::vector<View> views_of(const EngineTable& engines, const RunName& run, const std::vector<ProbeScene>& probes,
                           const RunName* of_points);
bool needs_same_method(const std::vector<View>& views);

// The tasks of a view, one for each dt.
std::vector<MotionTask> tasks_of(const View& view, const ProbeScene& probe, const Engine& engine,
                                 const Settings& settings, std::shared_ptr<const Fault> fault);
// The same after a nudge of every moving body by some roundings at the start. It shows chaos.
std::vector<MotionTask> nudged_tasks(std::vector<MotionTask> tasks);
// The sight from the view's motions, which begin at `first`.
Sight seen(const View& view, const std::vector<StateSeries>& motions, std::size_t first);

}  // namespace rigor::inline analysis
