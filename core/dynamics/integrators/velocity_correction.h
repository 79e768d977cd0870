// A velocity-level correction of contacts that an integrator calls once a step, at the place in its step that it names.
// The methods of contact are in dynamics/contact/; contact_methods.cpp there is the table.
#pragma once

#include <memory>

#include "core/dynamics/model/system.h"

namespace rigor::inline dynamics {

class Contact {
 public:
  virtual ~Contact() = default;
  // Changes velocities so that touching bodies no longer approach each other, at the positions of `state`.
  virtual void resolve(MutableBodyColumns state) = 0;
};

// For methods whose step cannot be split. Adds the effect of the loads at the step's start over dt, resolves these
// velocities, and subtracts the effect again. A body at rest thus stays at rest.
void resolve_ahead(Contact& contact, const System& system, const Wrenches& wrenches, double dt,
                   MutableBodyColumns state);

}  // namespace rigor::inline dynamics
