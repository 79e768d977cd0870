// What holds bodies together, as the equations of motion see it: forces found so that the accelerations keep the
// constraints. Null pointers to it mean bodies that nothing holds.
#pragma once

#include "core/engine/body_table.h"

namespace rigor {

class ConstraintForces {
 public:
  virtual ~ConstraintForces() = default;
  // Which of the rows that repeat others are left out is chosen anew at the state where a step begins, and kept for its
  // other stages: within a step the forces are a smooth function of the state.
  enum class Rows { chosen_anew, as_chosen };
  // The wrench columns (kernels.h) of all loads, `wrench` (null: none but gravity) and the constraints' forces, at
  // `state`. Valid until the next call.
  virtual const double* hold(BodyColumns state, const double* wrench, Rows rows) = 0;
};

}  // namespace rigor
