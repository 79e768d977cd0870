// Scenes with contact, and what carries them: an integrator of the core with one of its contact methods.
#pragma once

#include <boost/test/unit_test.hpp>
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <utility>

#include "core/dynamics/contact/contact_method.h"

namespace rigor::test {

class ContactRun {
 public:
  ContactRun(const Scene& scene, const std::string& method, const std::string& integrator_name = "velocity-verlet",
             std::map<std::string, std::string> options = {})
      : system_(scene), integrator_(integrator(integrator_name)), state_(scene.bodies.size()) {
    if (!integrator_.default_orientation.empty()) orientation_ = &orientation_update(integrator_.default_orientation);
    if (options.contains("threads")) system_.constants.use_threads(std::stoi(options.at("threads")));
    set_initial_state(scene, state_.columns());
    stepper_ = contact_method(method).make(
        scene, {system_, integrator_, orientation_, {integrator_name, std::move(options), Track::matched}});
  }

  void step(double dt) {
    stepper_->step(state_.columns(), time_, dt);
    time_ = ++steps_ * dt;
    if (solver_warning_.empty()) solver_warning_ = stepper_->solver_warning();
  }
  void run(double dt, int steps) {
    for (int i = 0; i < steps; ++i) step(dt);
  }

  ReportsContacts& contact_reports() { return *stepper_->contact_reports(); }
  BodyColumns state() const { return state_.columns(); }
  MutableBodyColumns state() { return state_.columns(); }
  double time() const { return time_; }
  std::optional<ReducedOrder> reduced_order() const { return stepper_->reduced_order(); }
  const std::string& solver_warning() const { return solver_warning_; }  // the first

 private:
  System system_;
  const Integrator& integrator_;
  const OrientationUpdate* orientation_ = nullptr;
  BodyTable state_;
  std::unique_ptr<ContactStepper> stepper_;
  double time_ = 0;
  int steps_ = 0;
  std::string solver_warning_;
};

inline Body solid(const std::string& name, const Shape& shape, const Vec3& position, double mass = 1) {
  Body body;
  body.name = name;
  body.mass = mass;
  body.shape = shape;
  body.inertia = inertia_of(shape, mass);
  body.position = position;
  body.collides = true;
  return body;
}

inline Body floor_at(const Vec3& normal = Vec3::UnitZ(), double offset = 0) {
  Body body;
  body.name = "floor";
  body.shape = Plane{normal, offset};
  body.fixed = body.collides = true;
  return body;
}

// On the floor z = 0.
inline Scene on_floor(std::vector<Body> bodies, const ContactLaw& law, const Vec3& gravity = {0, 0, -9.81}) {
  Scene scene;
  scene.gravity = gravity;
  scene.bodies = std::move(bodies);
  scene.bodies.push_back(floor_at());
  scene.contact_default = law;
  return scene;
}

// A box on the floor, and the same a quarter of a turn on, where each corner stands where another one stood.
struct QuarterTurn {
  QuarterTurn() {
    set_initial_state(scene, before.columns());
    scene.bodies[0].orientation = turn;
    set_initial_state(scene, after.columns());
  }
  const Quat turn = rotation_by({0, 0, 0.5 * std::numbers::pi});
  Scene scene = on_floor({solid("box", Box{{1, 1, 1}}, {0, 0, 0.5})}, {0, 0.5});
  BodyTable before{scene.bodies.size()}, after{scene.bodies.size()};
};

}  // namespace rigor::test
