// One way to solve a scene with contacts by the core's contact by events, for the truth 'events': an integrator, its
// step, thresholds, and the equivalent scene in which the motion is found.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "cases/truth/solved/events/equivalent_scene.h"
#include "cases/truth/solved/reference_solver.h"
#include "core/dynamics/contact/contact_method.h"
#include "core/dynamics/joints/joint_stops.h"

namespace rigor::inline truth {

struct EventsWay {
  const char* integrator;
  const char* tolerance;   // of an adaptive integrator; null for others
  const char* thresholds;  // times the default ones
  Equivalence seen;        // in the scene's own units
};

// Units of length and time, powers of two, in which the sizes and rates of the scene are about one.
struct OwnUnits {
  double length = 1, time = 1;  // each length and each time is multiplied by these
};
OwnUnits own_units(const Scene& scene);

// Makes steps of one scene in one way. States, times and steps are the original scene's.
class EventsStepping {
 public:
  EventsStepping(const Scene& scene, const EventsWay& way, const OwnUnits& units);

  // Takes the state of the original scene from t to t + dt. Returns whether neither the method nor the joints warn.
  bool step(MutableBodyColumns state, double t, double dt);
  // Sets the initial state, and returns to it.
  void start(MutableBodyColumns state);
  // Goes on from a state that is not the one that the last step left.
  void set(BodyColumns state);
  bool was_smooth() const { return stepper_->was_smooth(); }
  long work() const { return stepper_->work(); }  // steps of the integrator so far
  std::vector<ContactTie> ties() const;

 private:
  int original(int body) const;

  Equivalence seen_;
  Scene scene_;
  System system_;
  const Integrator& integrator_;
  const OrientationUpdate* orientation_ = nullptr;
  std::unique_ptr<Joints> joints_;      // null where there are none
  std::unique_ptr<JointStops> motors_;  // of given speed; null where there are none
  std::unique_ptr<ContactStepper> stepper_;
  BodyTable state_;  // of the equivalent scene
};

}  // namespace rigor::inline truth
