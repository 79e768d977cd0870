// Constraints between bodies, as seen by the equations of motion: forces for which the accelerations satisfy the
// constraints. A null pointer means bodies without constraints.
#pragma once

#include "core/engine/body_table.h"

namespace rigor::inline dynamics {

class ConstraintForces {
 public:
  virtual ~ConstraintForces() = default;
  // Redundant rows to leave out are chosen at the state where a step begins, and kept for its other stages. Within a
  // step the forces are thus a smooth function of the state.
  enum class Rows { chosen_anew, as_chosen };
  // The wrench columns (kernels.h) of all loads, `wrench` (null: none but gravity) and the constraints' forces, at
  // `state`. Valid until the next call.
  virtual const double* hold(BodyColumns state, const double* wrench, Rows rows) = 0;
};

}  // namespace rigor::inline dynamics
