// The contacts of many bodies from one time they are found to the next, for the method `impulse`: pairs that may meet
// until then, the points of each, and which of them were there the last time. A body's pairs are searched for anew only
// when it has left the box, wider than itself, in which it was searched for last; a pile at rest needs no search.
#pragma once

#include <array>
#include <vector>

#include "core/dynamics/collision/pair_finder.h"
#include "core/scene/contact_laws.h"

namespace rigor {

// A point of two bodies that touch or may meet within dt, in which case it is the one at which they will.
// Impulses are those of one sub-step.
struct PilePoint {
  int a, b;  // bodies
  std::uint32_t feature;
  Vec3 normal;        // unit, in W, from b to a
  Vec3 arm_a, arm_b;  // m, in W, from each body's centre of mass to its point
  double gap;         // m
  double friction, restitution;
  double normal_impulse = 0;             // N s
  Vec3 friction_impulse = Vec3::Zero();  // N s, in W
};

class Manifolds {
 public:
  explicit Manifolds(const Scene& scene)
      : colliders_(colliders_of(scene)),
        laws_(scene),
        poses_(colliders_.size()),
        boxes_(colliders_.size()),
        bounds_(colliders_.size()) {}

  // The points for the next dt, sorted by pair, with the impulses of the points of last time.
  std::vector<PilePoint>& find(BodyColumns state, double dt);

 private:
  void place_bodies(BodyColumns state, double dt);
  bool stay_apart(int a, int b) const;
  void update_pairs(BodyColumns state, double dt);
  void add_pair(BodyColumns state, double dt, const Collider& a, const Collider& b);
  void remember(std::size_t first, std::size_t& old);

  std::vector<Collider> colliders_;
  ContactLaws laws_;
  PairFinder finder_;
  std::vector<Pose> poses_;
  std::vector<Aabb> boxes_, wide_boxes_;
  std::vector<double> bounds_;  // m: how far from its pose a body can be met within dt
  std::vector<int> left_;       // colliders
  const std::vector<std::pair<int, int>>* pairs_ = nullptr;
  Manifold manifold_;
  double same_within_ = 0;  // m
  std::vector<PilePoint> points_, old_points_;
};

}  // namespace rigor
