// The interface of the core's contact methods: the contacts that a method supports, and a stepper that advances a scene
// with contacts by means of an integrator. Each method has its own file; contact_methods.cpp is the table.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "core/dynamics/integrators/integrator.h"
#include "core/engine/capabilities.h"
#include "core/scene/features/features.h"
#include "core/scene/scene.h"

namespace rigor::inline dynamics {

class JointStops;

// Bodies that meet in one instant, where the result depends on which pair meets first.
struct ContactTie {
  double time = 0;                         // s
  std::vector<std::pair<int, int>> pairs;  // of bodies
};

class ContactStepper : public Stepper {
 public:
  // What is in force beside the method's name.
  virtual SettingsInForce settings_in_force() const { return {}; }
  // Whether the last step had no impact and no other event inside it, so far as the method knows.
  virtual bool was_smooth() const { return false; }
  // Steps of the integrator that all steps so far have taken.
  virtual long work() const { return 0; }
  // From when on it did not keep the integrator's order in contact, if it says so.
  virtual std::optional<ReducedOrder> reduced_order() const { return {}; }
  // s, of the parts in which the last step was taken; none if it was taken as one.
  virtual std::optional<double> sub_step() const { return {}; }

  // Its contact forces; null if the method does not compute them.
  virtual ReportsContacts* contact_reports() { return nullptr; }

  // Asks it to look for ties from now on. A method that does not look finds none.
  virtual void watch_ties() {}
  virtual std::vector<ContactTie> ties() const { return {}; }
};

// What a contact stepper is made from. Outlives it.
struct ContactParts {
  const System& system;
  const Integrator& integrator;
  const OrientationUpdate* orientation;  // see StepperParts
  Settings settings;
  Joints* joints = nullptr;      // null where nothing holds the bodies together
  JointStops* motors = nullptr;  // of given speed, for a method without its own; null without motors
};

struct ContactMethod {
  std::string name;
  std::string summary;
  Features features;                     // the contacts it expresses; see feature.h
  std::vector<OptionInfo> options = {};  // of this method alone
  std::unique_ptr<ContactStepper> (*make)(const Scene& scene, const ContactParts& parts);
};

const std::vector<ContactMethod>& contact_methods();
const ContactMethod& contact_method(const std::string& name);  // the name must be there
// The default method of a run: `event`, which is correct at any step, if at most this many moving bodies collide.
// Otherwise the first of the table that supports the scene, or the first of all if none does.
inline constexpr int kFewCollidingBodies = 8;
bool has_few_colliding_bodies(const Scene& scene);
const ContactMethod& contact_method_for(const Scene& scene);

// A row's `make` for a stepper that is built from the scene and its parts.
template <typename S>
std::unique_ptr<ContactStepper> make_contact_stepper(const Scene& scene, const ContactParts& parts) {
  return std::make_unique<S>(scene, parts);
}

}  // namespace rigor::inline dynamics
