// The contact constraints of many bodies from one update to the next, for the method `impulse`: pairs that may meet
// until then (speculative contacts), the points of each, and the impulses of those that persist. A body's pairs are
// searched for anew only when it has left its fat box, in which it was searched for last; a pile at rest needs no
// search.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/dynamics/collision/broad_phase.h"
#include "core/scene/contact_laws.h"

namespace rigor {

// A contact point of two bodies that touch, or may meet before the next update; then it is where they will. Impulses
// are those of one sub-step.
struct ContactConstraint {
  int a, b;  // bodies
  std::uint32_t feature;
  Vec3 normal;        // unit, in W, from b to a
  Vec3 arm_a, arm_b;  // m, in W, from each body's centre of mass to its point
  double gap;         // m
  bool is_deep;       // a deep overlap that was there from the start
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
        bounding_radii_(colliders_.size()),
        overlaps_at_start_(scene.bodies.size()) {
    for (const Body& body : scene.bodies) names_.push_back(body.name);
  }

  // The constraints for the next dt, sorted by pair, with the impulses of those that persist from the last update.
  std::vector<ContactConstraint>& find(BodyColumns state, double dt);
  // Of bodies that have come to lie in each other; empty if none have.
  const std::string& failure() const { return failure_; }

 private:
  void place_bodies(BodyColumns state, double dt);
  bool stay_apart(int a, int b) const;
  void update_pairs(BodyColumns state, double dt);
  void add_pair(BodyColumns state, double dt, const Collider& a, const Collider& b);
  bool is_parted_from_start(const Collider& a, const Collider& b, double gap) const;
  void watch(const Collider& a, const Collider& b, double gap);
  void match_impulses(std::size_t first, std::size_t& old);

  std::vector<Collider> colliders_;
  ContactLaws laws_;
  BroadPhase broad_phase_;
  std::vector<Pose> poses_;
  std::vector<Aabb> boxes_, fat_boxes_;
  std::vector<double> bounding_radii_;  // m: of all that a body can reach within dt
  std::vector<int> moved_;              // colliders that left their fat boxes
  const std::vector<std::pair<int, int>>* pairs_ = nullptr;
  Manifold manifold_;
  double match_radius_ = 0;  // m
  bool is_first_ = true;
  std::vector<char> overlaps_at_start_;  // by body
  std::vector<std::string> names_;
  std::string failure_;
  std::vector<ContactConstraint> constraints_, old_constraints_;
};

}  // namespace rigor
