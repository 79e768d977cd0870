// A scene's shapes and contact laws in DART, which multiplies the restitutions of two shapes and takes the smaller
// friction. A body has one shape for each law that it takes part in. Only shapes of the law of their pair are tested
// against each other, so every pair has its own law.
#pragma once

#include <dart/collision/CollisionFilter.hpp>
#include <memory>

#include "adapters/dart/dart_bodies.h"

namespace rigor::inline adapters {

// Half the edge of the box whose upper face stands for a plane. m
inline constexpr double kDartPlaneReach = 500;

// Gives the bodies their shapes. The returned filter must be that of the world's collisions.
std::shared_ptr<::dart::collision::CollisionFilter> add_dart_shapes(const Scene& scene, DartBodies& made);

// The box that stands for a plane has edges.
class DartPlaneEdges {
 public:
  explicit DartPlaneEdges(const Scene& scene);
  // Throws EngineFailure for a body beside the box, where nothing would hold it: unsupported, or diverged if it is so
  // far away that it was thrown there.
  void check(BodyColumns bodies) const;

 private:
  struct Solid {
    std::size_t body;
    std::string name;
    double bounding_radius;  // m, about its centre
  };
  std::vector<Plane> planes_;
  std::vector<std::string> names_;  // of the planes
  std::vector<Solid> solids_;
};

}  // namespace rigor::inline adapters
