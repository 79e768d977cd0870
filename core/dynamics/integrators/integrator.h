// The interface of the core's integrators: facts of a method, and a stepper. Each method has its own file;
// integrators.cpp is the table.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/dynamics/integrators/orientation_updates.h"
#include "core/dynamics/integrators/velocity_correction.h"
#include "core/dynamics/model/constraint_forces.h"
#include "core/dynamics/model/system.h"
#include "core/engine/engine.h"

namespace rigor::inline engine {
class StateArchive;
}

namespace rigor::inline dynamics {

class Joints;

// Steps one system. A stepper may use its history only if the state and the instant are those of its last step's end.
class Stepper {
 public:
  virtual ~Stepper() = default;
  // Takes `state` from t to t + dt.
  virtual void step(MutableBodyColumns state, double t, double dt) = 0;
  // Why the last step is less accurate than the method promises; empty if it is not.
  virtual std::string solver_warning() const { return ""; }
  // Saves or restores what the next steps depend on beside the state of the bodies (state_archive.h).
  virtual void archive_state(StateArchive& archive) = 0;
};

// The error that an adaptive method allows in each inner step; see MotionEquations::relative_size().
inline const OptionInfo kToleranceOption{
    .name = "tolerance",
    .meaning = "error of an inner step, relative to 1 + the value in m, rad, m/s, rad/s",
    .min = 1e-14,
    .max = 1e-2,
    .by_default = 1e-12};

// What a stepper is made from. Outlives it.
struct StepperParts {
  const System& system;
  Contact* contact;                      // null where nothing can touch
  const OrientationUpdate* orientation;  // for methods with that option; null for the others
  Settings settings = {};                // with the values of the row's own options
  Joints* joints = nullptr;              // null where nothing holds the bodies together
  // There only while a stepper is made, for one that holds joints its own way; null where contacts are carried.
  const Scene* scene = nullptr;
  ConstraintForces* contact_forces = nullptr;  // null where no contact is held at each stage

  // The constraints that a method with holds_at_stages asks at each stage: the joints or the contact forces. No scene
  // has both; null if it has neither.
  ConstraintForces* constraints() const;
};

struct Integrator {
  std::string name;
  std::string summary;
  int order;                        // the global error falls as dt^order on smooth scenes
  bool symplectic;                  // on undamped smooth scenes
  bool symmetric = false;           // see MethodInfo
  double leapfrog_stagger;          // in steps, see MethodInfo
  std::string default_orientation;  // "" where the method has one way only
  bool adaptive = false;            // see MethodInfo; it then has kToleranceOption
  bool takes_contact = true;        // false: an impact would invalidate its history
  bool takes_joints = false;
  bool holds_at_stages = false;  // each of its stages asks StepperParts::constraints(), so that they keep its order
  bool takes_dampers_with_joints = true;  // only for methods that take joints
  Features lacks = {};                    // what else of feature.h it cannot express
  std::vector<OptionInfo> options = {};   // of this method alone
  std::string twin_of = "";               // see MethodInfo
  Features twin_takes = {};  // of armatures, couplings, compound, planar and screw joints: what its scheme has
  std::unique_ptr<Stepper> (*make)(const StepperParts& parts);
};

const std::vector<Integrator>& integrators();           // alphabetical
const Integrator& integrator(const std::string& name);  // the name must be there

// A row's `make` for a stepper that is built from its parts.
template <typename S>
std::unique_ptr<Stepper> make_stepper(const StepperParts& parts) {
  return std::make_unique<S>(parts);
}

}  // namespace rigor::inline dynamics
