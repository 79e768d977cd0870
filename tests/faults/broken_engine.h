// An engine that does everything as another does it, but for one thing. Its world is made anew from the state before
// every step where the fault needs that; whether that alone trips a gate, the tests ask first.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/engine/clock.h"
#include "core/engine/engine.h"

namespace rigor::test {

// A step that is about to be taken. The fault may change the bodies' state, the loads, dt and how often it is taken.
struct Moment {
  Scene& scene;           // the bodies as they are now; t = 0 is now
  const Scene& original;  // as it was loaded
  double& dt;             // s
  int& times;             // that the step is taken
  long step;              // counted from 0
  double time;            // s
};

struct Fault {
  std::string name;
  std::string shown_by;                    // the case whose gates must find it
  std::string metrics;                     // a regular expression: the metrics of the gates that point at it
  std::function<void(Scene&)> scene = {};  // on loading
  std::function<void(Moment&)> step = {};  // before each step
  std::function<void(MutableBodyColumns, const Scene&)> read = {};  // on reading
  bool reads_late = false;                                          // gives the state of the step before
};

class BrokenEngine : public Engine {
 public:
  BrokenEngine(const Engine& engine, Fault fault) : engine_(engine), fault_(std::move(fault)) {}
  EngineInfo info() const override { return engine_.info(); }
  std::string twin(const Settings& settings) const override { return engine_.twin(settings); }
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override;

 private:
  const Engine& engine_;
  Fault fault_;
};

}  // namespace rigor::test
