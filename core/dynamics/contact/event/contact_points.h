// The points at which a scene's bodies touch at one instant, for the method `event`.
#pragma once

#include <vector>

#include "core/dynamics/collision/pair_finder.h"
#include "core/dynamics/contact/event/acceleration_bounds.h"
#include "core/dynamics/contact/event/cone_solver.h"
#include "core/scene/contact_laws.h"

namespace rigor {

struct Touch {
  int a, b;  // colliders
  std::uint32_t feature;
  double gap;  // m
  double restitution;
  ConePoint cone;
  bool same_place(const Touch& other) const { return a == other.a && b == other.b && feature == other.feature; }
};

class Touches {
 public:
  explicit Touches(const Scene& scene) : colliders_(colliders_of(scene)), laws_(scene) {}

  const std::vector<Collider>& colliders() const { return colliders_; }
  // The pairs that can touch while the bodies go from one state to the other within dt, accelerated by no more than the
  // bounds, one for each body.
  const std::vector<std::pair<int, int>>& candidates(BodyColumns from, BodyColumns to, double dt,
                                                     const AccelerationBounds& bounds);
  // Those that touch now, or nearly so.
  const std::vector<std::pair<int, int>>& candidates(BodyColumns state);
  // Every point of the pair, whatever its gap.
  const Manifold& manifold(BodyColumns state, int a, int b);
  // Unit, from b to a: the direction along which the pair is furthest apart, or least deep in each other.
  Vec3 parting(BodyColumns state, int a, int b);
  // Adds each point of the candidates that is closer than `gap`.
  void find(BodyColumns state, const std::vector<std::pair<int, int>>& pairs, double gap, std::vector<Touch>& out);
  // The least gap of each pair, in the pairs' order.
  void least_gaps(BodyColumns state, const std::vector<std::pair<int, int>>& pairs, std::vector<double>& out);
  // The touch at the same place in another state: the same feature, or the nearest of the pair. False if the pair has
  // none; the touch is then left as it was. The tangents turn with the normal and no further.
  bool follow(BodyColumns state, Touch& touch);

 private:
  const std::vector<std::pair<int, int>>& overlapping_boxes();
  void place(BodyColumns state, const ContactPoint& point, Touch& touch) const;

  std::vector<Collider> colliders_;
  ContactLaws laws_;
  PairFinder finder_;
  std::vector<Aabb> boxes_;
  std::vector<std::pair<int, int>> pairs_;
  Manifold manifold_;
};

}  // namespace rigor
