// The same scene written down differently: its rows in another order, or many copies of it side by side.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline analysis {

struct ReorderedScene {
  Scene scene;
  std::vector<std::size_t> places;  // of each body of the original in the new scene
};

// All rows in a random order: bodies, joints, springs, motors, pairs and forces.
ReorderedScene reordered(const Scene& scene, std::uint64_t seed);

// The scene moved by `offset` [m], without what cannot tell the difference: planes stay.
Scene moved_scene(const Scene& scene, const Vec3& offset);

// A unit direction along which the scene can be moved past its planes; none if its planes leave no such direction.
std::optional<Vec3> free_direction(const Scene& scene);

// So many copies, the k-th moved by k times `offset`. Planes are shared. The bodies of copy k are places[k].
struct CopiedScene {
  Scene scene;
  std::vector<std::vector<std::size_t>> places;
};
CopiedScene copied(const Scene& scene, std::size_t copies, const Vec3& offset);

}  // namespace rigor::inline analysis
