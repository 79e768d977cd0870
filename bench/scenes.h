// The scenes that are timed. Sleeping is off wherever an engine can be told so, and every body moves for as long as a
// benchmark lasts.
#pragma once

#include <string>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::bench {

// What a method reaches beside its speed.
enum class Reached {
  trajectory,       // largest distance [m] or angle [rad] from the adaptive method at its tolerance, after 1 s
  energy,           // largest deviation, relative to the largest kinetic energy
  penetration,      // deepest overlap [m]
  joint_gap,        // widest gap of a joint [m]
  gap_and_overlap,  // both of these, of robots on a floor
};

struct SceneRow {
  std::string name;
  std::vector<int> sizes;  // bodies
  double dt;               // s
  Reached reached;
  bool goes_on;  // the motion never ends or grows: one world may be stepped for as long as the timing takes
  Scene (*make)(const SceneRow& row, int bodies);
};

const std::vector<SceneRow>& scenes();  // one row a scene
const SceneRow& scene_row(const std::string& name);

// The steps of an interval that is timed.
int steps_of_interval(const SceneRow& row, int count);

// Made once and kept.
const Scene& scene_of(const SceneRow& row, int bodies);

}  // namespace rigor::bench
