// The classical fourth-order Runge–Kutta tableau (weights 1/6, 1/3, 1/3, 1/6 at 0, 1/2, 1/2, 1) over the equations of
// motion in either chart. A timed force that begins or ends inside a step divides it there.
#pragma once

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/motion_equations.h"
#include "core/dynamics/wrench_columns.h"

namespace rigor {

class ClassicalRungeKutta : public Stepper {
 public:
  ClassicalRungeKutta(const StepperParts& parts, OrientationChart chart);
  void step(MutableBodyColumns state, double t, double dt) override;

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

}  // namespace rigor
