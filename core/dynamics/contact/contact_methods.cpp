#include <algorithm>
#include <cassert>

#include "core/dynamics/contact/contact_method.h"

namespace rigor {

extern const ContactMethod kCourseContact, kEventContact, kImpulseContact;

// Not alphabetical: see contact_method_for().
const std::vector<ContactMethod>& contact_methods() {
  static const std::vector<ContactMethod> table = {kCourseContact, kImpulseContact, kEventContact};
  return table;
}

const ContactMethod& contact_method(const std::string& name) {
  const auto& table = contact_methods();
  const auto row = std::find_if(table.begin(), table.end(), [&](const auto& r) { return r.name == name; });
  assert(row != table.end() && "option values are checked when the run is named");
  return *row;
}

namespace {

// Of five random mechanisms with friction two by `event` with `dormand-prince` divide their steps without end. A slip
// that begins on the verge of its cone, or that ends, is stiff: friction turns its direction within u m/(mu f_n), 1e-10
// s at the 1e-9 m/s at which it gets a direction of its own, and that may be another than the one in which it was held.
bool rubs_through_joints(const std::vector<Need>& needs) {
  const auto needed = [&](const char* feature) {
    return std::any_of(needs.begin(), needs.end(), [&](const Need& need) { return need.feature == feature; });
  };
  return needed("joints-with-contacts") && (needed("friction:coulomb") || needed("friction:infinite"));
}

}  // namespace

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
    // What no method has is not contact's to express.
    return std::all_of(needs.begin(), needs.end(), [&](const Need& need) {
      return method.features.contains(need.feature) || !of_all.contains(need.feature);
    });
  };
  if (has_few_colliding_bodies(scene) && expresses(kEventContact) && !rubs_through_joints(needs)) return kEventContact;
  const auto& table = contact_methods();
  const auto found = std::find_if(table.begin(), table.end(), expresses);
  return found == table.end() ? table.front() : *found;
}

}  // namespace rigor
