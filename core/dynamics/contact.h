// How the core treats contact: a velocity-level correction that each integrator calls once a step, at the place in its
// step that it names.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/dynamics/system.h"
#include "core/scene/features.h"
#include "core/scene/scene.h"

namespace rigor {

class Contact {
 public:
  virtual ~Contact() = default;
  // Changes velocities so that touching bodies no longer approach each other, at the positions of `state`.
  virtual void resolve(MutableBodyColumns state) = 0;
};

// For methods whose step cannot be opened: resolves the velocities as the loads at its start would leave them at its
// end, so that a body at rest stays at rest, and hands them back without those loads.
void resolve_ahead(Contact& contact, const System& system, const Wrenches& wrenches, double dt,
                   MutableBodyColumns state);

struct ContactMethod {
  std::string name;
  std::string summary;
  Features features;  // the contacts it expresses; see features.h
  // Null where nothing in the scene can touch. The system outlives what is made.
  std::unique_ptr<Contact> (*make)(const Scene& scene, const System& system);
};

const std::vector<ContactMethod>& contact_methods();           // the first is the default
const ContactMethod& contact_method(const std::string& name);  // the name must be there

// The course's rule: see course_contact.cpp.
extern const ContactMethod kCourseContact;

}  // namespace rigor
