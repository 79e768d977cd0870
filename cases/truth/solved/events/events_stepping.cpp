#include "cases/truth/solved/events/events_stepping.h"

#include <algorithm>
#include <cmath>

#include "core/dynamics/model/contact_scales.h"

namespace rigor::inline truth {
namespace {

constexpr const char* kPatience = "10";  // what a run takes in inelastic steps is found event by event here

// A surface of triangles is not mirrored: the diagonals of a height field's cells would not be those of one.
Equivalence seen_by(const EventsWay& way, const OwnUnits& units, const Scene& scene) {
  Equivalence seen = way.seen;
  seen.length = units.length, seen.time = units.time;
  seen.is_mirrored = seen.is_mirrored && std::none_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& body) {
                       return body.shape && surface_in(*body.shape);
                     });
  return seen;
}

}  // namespace

OwnUnits own_units(const Scene& scene) {
  const ContactScales scales = contact_scales(scene);
  return {std::ldexp(1, -std::ilogb(scales.length)), std::ldexp(1, -std::ilogb(scales.time))};
}

EventsStepping::EventsStepping(const Scene& scene, const EventsWay& way, const OwnUnits& units)
    : seen_(seen_by(way, units, scene)),
      scene_(equivalent(scene, seen_)),
      system_(scene_),
      integrator_(integrator(way.integrator)) {
  if (!integrator_.default_orientation.empty()) orientation_ = &orientation_update(integrator_.default_orientation);
  Settings settings;
  settings.method = way.integrator;
  if (way.tolerance) settings.options["tolerance"] = way.tolerance;
  settings.options["thresholds"] = way.thresholds;
  settings.options["patience"] = kPatience;
  if (!scene_.joints.empty()) joints_ = std::make_unique<Joints>(scene_, system_);
  if (JointStops::has_speed_motors(scene_))
    motors_ = std::make_unique<JointStops>(scene_, system_, system_.loads, *joints_, JointStops::Of::motors);
  stepper_ = contact_method("event").make(scene_,
                                          {system_, integrator_, orientation_, settings, joints_.get(), motors_.get()});
  stepper_->watch_ties();
  state_.resize(scene_.bodies.size(), orientation_ && orientation_->keeps_matrix);
}

void EventsStepping::start(MutableBodyColumns state) {
  set_initial_state(scene_, state_.columns());
  to_original(seen_, std::as_const(state_).columns(), state);
}

void EventsStepping::set(BodyColumns state) {
  to_equivalent(seen_, state, state_.columns());
  if (!state_.has_rotation()) return;
  for (std::size_t i = 0; i < state_.size(); ++i)
    state_.columns().set_rotation(i, matrix_of(state_.columns().orientation(i)));
}

bool EventsStepping::step(MutableBodyColumns state, double t, double dt) {
  if (joints_) joints_->begin_step();
  stepper_->step(state_.columns(), t * seen_.time, dt * seen_.time);
  if (joints_) joints_->end_step(state_.columns());
  to_original(seen_, std::as_const(state_).columns(), state);
  return stepper_->solver_warning().empty() && (!joints_ || joints_->warning().empty());
}

int EventsStepping::original(int body) const {
  return body == kWorld || !seen_.is_reversed ? body : static_cast<int>(scene_.bodies.size()) - 1 - body;
}

std::vector<ContactTie> EventsStepping::ties() const {
  std::vector<ContactTie> ties = stepper_->ties();
  for (ContactTie& tie : ties) {
    tie.time /= seen_.time;
    for (auto& [a, b] : tie.pairs) a = original(a), b = original(b);
  }
  return ties;
}

}  // namespace rigor::inline truth
