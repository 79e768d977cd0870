// The classical fourth-order Runge–Kutta tableau (weights 1/6, 1/3, 1/3, 1/6 at 0, 1/2, 1/2, 1) for the equations of
// motion. Variables are position, velocity, angular momentum L in W, and the orientation. The orientation is a
// quaternion, of which only the direction matters, or the rotation vector phi from the step's start, R = exp([phi]x)
// R0, with (Iserles, Munthe-Kaas, Nørsett, Zanna, Lie-group methods, 2000)
//   phi' = w - phi x w / 2 + phi x (phi x w) / 12 + O(phi⁴),
// cut there, which leaves methods up to order 4 their order. A timed force that begins or ends inside a step divides it
// there.
#pragma once

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/model/wrench_columns.h"

namespace rigor::inline dynamics {

enum class OrientationChart { quaternion, rotation_vector };

class ClassicalRungeKutta : public Stepper {
 public:
  ClassicalRungeKutta(const StepperParts& parts, OrientationChart chart);
  void step(MutableBodyColumns state, double t, double dt) override;
  void archive_state(StateArchive&) override {}  // nothing outlives a step

 private:
  void smooth_part(MutableBodyColumns state, double t, double dt);
  void take_stage(std::size_t s, const Bodies& block, MutableBodyColumns state, const double* wrench, double dt);

  StepperParts parts_;
  OrientationChart chart_;
  WrenchColumns loads_;
  BodyTable stage_, sum_;
  Columns carried_;
  Wrenches wrenches_;
};

}  // namespace rigor::inline dynamics
