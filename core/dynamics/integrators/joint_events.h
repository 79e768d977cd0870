// Limits of joints and motors of given speed, for any method that takes joints. A step is divided where a limit is
// reached or released, and where a motor reaches its speed or can no longer keep it. Each such instant is located as a
// root by repeating the step with other lengths. Between these instants the equations are smooth, so the method keeps
// its order. joint_stops.h handles the change at such an instant.
#pragma once

#include <memory>
#include <string>

#include "core/dynamics/integrators/integrator.h"
#include "core/dynamics/joints/joint_stops.h"

namespace rigor::inline dynamics {

class JointEvents : public Stepper {
 public:
  // `system` and `joints` must outlive it, and are those of `inner`; its loads get the efforts of motors.
  JointEvents(const Scene& scene, System& system, Joints& joints, std::unique_ptr<Stepper> inner);

  void step(MutableBodyColumns state, double t, double dt) override;
  std::string solver_warning() const override { return solver_warning_; }
  void archive_state(StateArchive& archive) override;

 private:
  // Takes the settled state from t until the first event, at most by h, and returns by how much.
  double advance(MutableBodyColumns state, double t, double h);
  // Where a step of length h from start_ ends, in trial_.
  void attempt(double t, double h);
  // The first instant in [0, h] at which it happens, where trial_ is at h and it has or may have happened; or h.
  double time_of(std::size_t stop, JointStops::Event event, double t, double h);
  // A root in [0, h] of a function that is below zero at 0 and not at h.
  template <typename Function>
  double root(const Function& f, double h, double at_end) const;
  void warn(const std::string& what);

  Joints& joints_;
  JointStops stops_;
  std::unique_ptr<Stepper> inner_;
  BodyTable start_, trial_;
  double whole_step_ = 0;  // s
  std::string noted_, solver_warning_;
};

}  // namespace rigor::inline dynamics
