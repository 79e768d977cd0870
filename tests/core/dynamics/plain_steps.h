// One step of the core's methods, written body by body directly from the formulas. The kernels' steps are compared with
// it.
#pragma once

#include <string>
#include <vector>

#include "core/dynamics/model/system.h"

namespace rigor::test {

// No contact, no timed force that begins or ends inside the step, dampers only where the method's own formula has them.
using PlainStep = void (*)(const System& system, BodyTable& state, double t, double dt);

struct PlainMethod {
  std::string name;         // a row of integrators.cpp
  std::string orientation;  // a row of orientation_updates.cpp, "" where the method has one way only
  bool takes_dampers;
  PlainStep step;
};
const std::vector<PlainMethod>& plain_methods();

}  // namespace rigor::test
