// The two halves of an Euler step, a change of velocities and a change of poses, on a block of bodies, for each way to
// carry an orientation: the kernels for quaternions, body by body for matrices.
#pragma once

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/kernels/kernels.h"

namespace rigor {

class EulerPasses {
 public:
  explicit EulerPasses(const StepperParts& parts) : system_(parts.system), orientation_(*parts.orientation) {}

  // v += dt F/m, w += dt I⁻¹ (tau - w x I w). `wrench` is null where nothing but gravity acts.
  void kick(const Bodies& block, MutableBodyColumns state, const double* wrench, double dt) const;
  // x += dt v, and a turn by dt w.
  void drift(const Bodies& block, MutableBodyColumns state, double dt) const;
  // Both from what was known before.
  void kick_and_drift_at_once(const Bodies& block, MutableBodyColumns state, const double* wrench, double dt) const;

 private:
  const System& system_;
  const OrientationUpdate& orientation_;
};

}  // namespace rigor
