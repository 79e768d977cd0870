// The table of generators of scenes. Each makes any number of scenes, one for each seed.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::test {

struct SceneRow {
  std::string name;
  std::function<Scene(unsigned seed)> make;
};

const std::vector<SceneRow>& scene_rows();
Scene generated_scene(const std::string& row, unsigned seed);

// One to four bodies with springs, dampers and forces, tied to the world or to each other alone.
Scene smooth_scene(unsigned seed);
// A tree of two to five bodies with every type of joint, springs, dampers, limits, motors, servos and couplings.
Scene mechanism(unsigned seed);
// The same with compound joints in most places.
Scene compound_mechanism(unsigned seed);
// One to four spheres, boxes and capsules above a tilted plane.
Scene bodies_on_plane(unsigned seed);
// Two to four of them without a plane, which fly towards each other.
Scene bodies_in_flight(unsigned seed);
// A cylinder and up to two spheres above a tilted plane.
Scene cylinder_on_plane(unsigned seed);
// A capsule above a fixed body, parallel to its axis, its edge or its face, exactly or nearly so.
Scene line_contact(unsigned seed);
// A box that lands on four corners at once.
Scene level_box(unsigned seed);
// Scenes whose truths or runs once contradicted those of related scenes. There are only so many.
inline constexpr int kContradicted = 6;
Scene once_contradicted(unsigned seed);

}  // namespace rigor::test
