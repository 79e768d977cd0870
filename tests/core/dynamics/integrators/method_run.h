// A method of the core, or a twin, stepped by itself: no engine around it, no truth beside it.
#pragma once

#include <memory>
#include <string>

#include "core/dynamics/integrators/integrator.h"

namespace rigor::test {

struct Method {
  const Integrator* integrator;
  const OrientationUpdate* orientation;  // null where the method has one way only
  std::string name() const { return integrator->name + (orientation ? "," + orientation->name : ""); }
};

class MethodRun {
 public:
  MethodRun(const Scene& scene, const Method& method, const Settings& settings = {})
      : system_(scene), state_(scene.bodies.size(), method.orientation && method.orientation->keeps_matrix) {
    set_initial_state(scene, state_.columns());
    stepper_ = method.integrator->make({system_, nullptr, method.orientation, settings});
  }
  void steps(double dt, int count) {
    for (int k = 0; k < count; ++k) {
      stepper_->step(state_.columns(), t_, dt);
      t_ += dt;
      if (solver_warning_.empty()) solver_warning_ = stepper_->solver_warning();
    }
  }
  BodyColumns bodies() const { return state_.columns(); }
  const std::string& solver_warning() const { return solver_warning_; }

 private:
  System system_;
  BodyTable state_;
  std::unique_ptr<Stepper> stepper_;
  double t_ = 0;  // s
  std::string solver_warning_;
};

}  // namespace rigor::test
