// The two halves of an Euler step on a block of bodies: a change of velocities and a change of poses. There is one
// variant per orientation update. Quaternions use the kernels; matrices are updated body by body.
#pragma once

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/kernels/kernels.h"

namespace rigor::inline dynamics {

class EulerPasses {
 public:
  explicit EulerPasses(const StepperParts& parts) : system_(parts.system), orientation_(*parts.orientation) {}

  // v += dt F/m, w += dt I⁻¹ (tau - w x I w). `wrench` is null if only gravity acts.
  void kick(const Bodies& block, MutableBodyColumns state, const double* wrench, double dt) const;
  // x += dt v, and a turn by dt w.
  void drift(const Bodies& block, MutableBodyColumns state, double dt) const;
  // Both use only values from before the step.
  void kick_and_drift_at_once(const Bodies& block, MutableBodyColumns state, const double* wrench, double dt) const;

 private:
  const System& system_;
  const OrientationUpdate& orientation_;
};

}  // namespace rigor::inline dynamics
