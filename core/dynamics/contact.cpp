#include "core/dynamics/contact.h"

#include <algorithm>
#include <cassert>

namespace rigor {

namespace {

void kick(const System& system, const Wrenches& wrenches, double dt, MutableBodyColumns state) {
  for (std::size_t i = 0; i < state.size(); ++i) {
    const Inertia& body = system.bodies[i];
    const Mat3 R = state.rotation(i);
    state.set_velocity(i, state.velocity(i) + dt * body.inverse_mass * wrenches[i].force);
    state.set_angular_velocity(
        i, state.angular_velocity(i) + dt * (R * (body.inverse_inertia_B * (R.transpose() * wrenches[i].torque))));
  }
}

}  // namespace

void resolve_ahead(Contact& contact, const System& system, const Wrenches& wrenches, double dt,
                   MutableBodyColumns state) {
  kick(system, wrenches, dt, state);
  contact.resolve(state);
  kick(system, wrenches, -dt, state);
}

const std::vector<ContactMethod>& contact_methods() {
  static const std::vector<ContactMethod> table = {kCourseContact};
  return table;
}

const ContactMethod& contact_method(const std::string& name) {
  const auto& table = contact_methods();
  const auto row = std::find_if(table.begin(), table.end(), [&](const auto& r) { return r.name == name; });
  assert(row != table.end() && "option values are checked when the run is named");
  return *row;
}

}  // namespace rigor
