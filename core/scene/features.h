// The features that a scene needs of an engine, and those that an engine declares. They are compared before a scene is
// loaded. A scene that an engine cannot express ends as `unsupported`, with the reason, and is never approximated
// silently.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor {

// A feature is a word: "spring", "timed-force", "fixed-body", "contact:box-plane", "restitution", "friction:none",
// "friction:coulomb", "friction:infinite"; "joint:hinge", "joint-spring", "joint-damper", "joint-limit",
// "joint-friction", "motor:effort", "motor:servo", "motor:speed", "motor:table" for an effort that changes in time;
// "contact-filter" for pairs that never touch; and for what is more than its parts
// "joints-with-contacts", "joints-with-dampers". The two shapes of a contact stand in alphabetical order.
using Features = std::set<std::string>;

struct Need {
  std::string feature;
  std::string because;  // what in the scene asks for it, e.g. "bodies 'ball' and 'ground' may touch"
};

// Each feature once, with the first thing that asks for it. Contact features come from the pairs of colliding bodies
// of which at least one can move.
std::vector<Need> needs_of(const Scene& scene);

// "contact:sphere-plane" and the like, for two shapes in either order.
std::string contact_feature(const std::string& shape_a, const std::string& shape_b);

// The contacts of every two shapes that can meet: spheres, boxes and capsules with each other, and each with a plane.
Features contacts_of_all_shapes();

// "joint:ball" and the like, for every joint type.
Features joints_of_all_types();

// `a` and `b` together.
Features joined(Features a, const Features& b);

}  // namespace rigor
