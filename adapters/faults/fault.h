// A mistake that has been seen in engines and their adapters, described by its changes: of the scene on loading, of the
// state before each step, or of the read values.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/engine/body_table.h"
#include "core/engine/capabilities.h"
#include "core/scene/scene.h"

namespace rigor::inline adapters {

// A step that is about to be taken. The fault may change the bodies' state, the loads, dt and the number of times that
// the step is taken.
struct Moment {
  Scene& scene;           // the bodies as they are now; t = 0 is now
  BodyColumns before;     // the bodies one step earlier; at the first step, as they are now
  const Scene& original;  // as it was loaded
  double& dt;             // s
  int& times;             // that the step is taken
  long step;              // counted from 0
  double time;            // s
};

struct Fault {
  std::string name = "";
  std::function<void(Scene&)> scene = {};                            // on loading
  std::function<void(Moment&)> step = {};                            // before each step, of scenes without joints
  std::function<void(MutableBodyColumns, const Scene&)> read = {};   // on reading
  std::function<void(std::vector<ReportedContact>&)> contacts = {};  // on reading contact forces
  bool reads_late = false;                                           // gives the state of the step before
  // For a fault by an amount: this amount in the unit of its name, and the same fault by another amount.
  double amount = 0;
  std::function<Fault(double)> by = {};
};

// Both of them; `first` comes first where they conflict.
Fault combined(const Fault& first, const Fault& second);

}  // namespace rigor::inline adapters
