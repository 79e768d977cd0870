#include <algorithm>
#include <cassert>

#include "core/dynamics/contact/contact_method.h"

namespace rigor::inline dynamics {

extern const ContactMethod kCourseContact, kEventContact, kImpulseContact, kSoftContact;

// Not alphabetical: see contact_method_for().
const std::vector<ContactMethod>& contact_methods() {
  static const std::vector<ContactMethod> table = {kCourseContact, kImpulseContact, kEventContact, kSoftContact};
  return table;
}

const ContactMethod& contact_method(const std::string& name) {
  const auto& table = contact_methods();
  const auto row = std::find_if(table.begin(), table.end(), [&](const auto& r) { return r.name == name; });
  assert(row != table.end() && "option values are checked when the run is named");
  return *row;
}

bool has_few_colliding_bodies(const Scene& scene) {
  const auto count = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                   [](const Body& body) { return body.collides && !body.fixed; });
  return count <= kFewCollidingBodies;
}

const ContactMethod& contact_method_for(const Scene& scene) {
  Features of_all;
  for (const ContactMethod& method : contact_methods()) of_all.insert(method.features.begin(), method.features.end());
  const std::vector<Need> needs = needs_of(scene);
  const auto expresses = [&](const ContactMethod& method) {
    // Features that no method has do not concern contact.
    return std::all_of(needs.begin(), needs.end(), [&](const Need& need) {
      return method.features.contains(need.feature) || !of_all.contains(need.feature);
    });
  };
  if (has_few_colliding_bodies(scene) && expresses(kEventContact)) return kEventContact;
  const auto& table = contact_methods();
  const auto found = std::find_if(table.begin(), table.end(), expresses);
  return found == table.end() ? table.front() : *found;
}

}  // namespace rigor::inline dynamics
