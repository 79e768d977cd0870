// Conditions that every scene must meet, from a file, an importer, or a search over its values. A reader adds the line
// and the column.
#pragma once

#include <optional>
#include <string>

#include "core/base/unit_vector.h"
#include "core/scene/scene.h"

namespace rigor::inline scene {

// The fault of a row, and its key as the case file names it; "" for the row as a whole.
struct SceneFault {
  std::string key, what;
};

// None where all is well. Bodies and joints that a row refers to must be there already.
std::optional<SceneFault> fault_of(const Body& body);
std::optional<SceneFault> fault_of_name(const std::string& body);
// For the two ends of a spring or joint, `what`: at least one must be able to move.
std::optional<SceneFault> fault_of_ends(int a, int b, const char* what, const Scene& scene);
std::optional<SceneFault> fault_of(const Spring& spring, const Scene& scene);
std::optional<SceneFault> fault_of(const Joint& joint, const Scene& scene);  // initial velocities that break it aside
std::optional<SceneFault> fault_of(const Coupling& coupling, const Scene& scene);
// Of couplings[last], if it closes a circle with those before.
std::optional<SceneFault> fault_of_circle(const std::vector<Coupling>& couplings, std::size_t last, const Scene& scene);
std::optional<SceneFault> fault_of(const Motor& motor, const Scene& scene);
std::optional<SceneFault> fault_of(const ContactLaw& law);
std::optional<SceneFault> fault_of_times(double from, double until);
std::optional<SceneFault> not_at_least_zero(const char* key, double value);
// A stiffness that grows with the extension adds to one that does not.
std::optional<SceneFault> fault_of_quadratic(double stiffness, double quadratic_stiffness);
std::optional<SceneFault> fault_of(const ContactPair& pair, const Scene& scene);
std::optional<SceneFault> fault_of_default(const Scene& scene);  // of contact_default
std::optional<SceneFault> fault_of(const TimedForce& force, const Scene& scene);

// What is wrong with an inertia; empty if it is one that matter can have: each principal moment is positive, and none
// is greater than the sum of the other two.
std::string why_no_inertia(const Mat3& inertia);

// Throws InputError, "body 'cube': inertia: ...", for the first row that no scene can have, and for names given twice.
void validate(const Scene& scene);

}  // namespace rigor::inline scene
