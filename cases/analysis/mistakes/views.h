// How an engine's motion on a probe is seen beside that of a known mistake, so that what the engine's scheme must do at
// a step of this size is in neither:
// - by its twin, which makes the same mistakes of the scheme to rounding;
// - extrapolated to a step of nothing from three step sizes, beside the accurate core treated likewise;
// - by a method of the core that steps points as the engine does, for mistakes that hang on the step;
// - as it is, beside the accurate core: for methods of high order, and where bodies touch.
#pragma once

#include <string>
#include <vector>

#include "cases/analysis/mistakes/motions.h"
#include "cases/analysis/mistakes/probes.h"
#include "core/engine/run_name.h"

namespace rigor {

struct View {
  enum class Kind { twin, extrapolated, same_method, accurate } kind;
  std::size_t probe;
  RunName base;            // of the core
  std::vector<double> dt;  // s, one, or three that halve
  long steps, every;       // of the first dt
  int order = 1;           // of the engine's method, by which three are extrapolated
  double tolerance = 0;    // what the kind of view leaves open, in scaled numbers
  bool can_touch = false;  // an engine sees an impact by up to a step too late
};

// What is seen of one motion.
struct Sight {
  std::vector<double> states;  // as StateSeries's
  // The same less surely, to see what is left open: of an extrapolated one from the two finer steps alone; of an
  // engine's beside its twin as roundings may move it (nudged_tasks); else empty.
  std::vector<double> coarse;
  std::string why;               // there is none; empty if there is
  bool as_loaded_alone = false;  // of a mistake: nothing is held against its motion after that
};

// The views of a run on the probes. `of_points`: the base of Kind::same_method; null where that is not needed.
std::vector<View> views_of(const EngineTable& engines, const RunName& run, const std::vector<ProbeScene>& probes,
                           const RunName* of_points);
bool needs_same_method(const std::vector<View>& views);

// The tasks of a view, one for each of its dt.
std::vector<MotionTask> tasks_of(const View& view, const ProbeScene& probe, const Engine& engine,
                                 const Settings& settings, std::shared_ptr<const Fault> fault);
// The same with every moving body nudged by some roundings at the start, by which chaos shows.
std::vector<MotionTask> nudged_tasks(std::vector<MotionTask> tasks);
// Of their motions, from `first` on.
Sight seen(const View& view, const std::vector<StateSeries>& motions, std::size_t first);

}  // namespace rigor
