// The points at which a scene's bodies touch at one instant, for the method `event`; and limits of joints, which are
// contacts without friction.
#pragma once

#include <vector>

#include "core/dynamics/collision/broad_phase.h"
#include "core/dynamics/contact/event/clearance/acceleration_bounds.h"
#include "core/dynamics/contact/event/cone_solver.h"
#include "core/dynamics/joints/joint_limits.h"
#include "core/dynamics/model/contact_scales.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline dynamics {

struct ContactPoint {
  int a, b;                              // colliders; kLimit of a limit
  std::uint32_t feature;                 // of a limit: which
  std::uint16_t part_a = 0, part_b = 0;  // of compounds: which part touches
  double gap;                            // m; rad of a hinge's limit
  double restitution;
  double static_friction = 0;  // while it does not slide, at least cone.friction
  ConeConstraint cone;
  static constexpr int kLimit = -1;
  // In the scene's units of gaps: a gap this small is closed.
  static constexpr double kClosed = 1e-10;
  bool is_limit() const { return a == kLimit; }
  bool same_place(const ContactPoint& other) const { return a == other.a && b == other.b && feature == other.feature; }
};

class ContactPoints {
 public:
  // `factor` multiplies each threshold.
  explicit ContactPoints(const Scene& scene, double factor = 1)
      : scales_(contact_scales(scene, factor)), colliders_(colliders_of(scene)), laws_(scene), limits_(scene) {}

  // The units of all thresholds.
  const ContactScales& scales() const { return scales_; }

  const std::vector<Collider>& colliders() const { return colliders_; }
  const JointLimits& limits() const { return limits_; }
  // The state from which hinges are counted: one that the run has reached, `since` [s] after the last.
  void note_turns(BodyColumns state, double since) { limits_.note(state, since); }
  // The turns alone: all else follows from the bodies' state.
  template <typename Archive>
  void archive_state(Archive& archive) {
    archive(limits_);
  }
  // The pairs that can touch while the bodies go from one state to the other within dt, with accelerations within the
  // bounds, one for each body.
  const std::vector<std::pair<int, int>>& candidates(BodyColumns from, BodyColumns to, double dt,
                                                     const AccelerationBounds& bounds);
  // Those that touch now, or nearly so.
  const std::vector<std::pair<int, int>>& candidates(BodyColumns state);
  // Every point of the pair, with any gap.
  const Manifold& manifold(BodyColumns state, int a, int b);
  // Unit, from b to a: the separating axis of the largest gap, or the one of the least overlap.
  Vec3 separating_axis(BodyColumns state, int a, int b);
  // Adds each point of the candidates, and each limit, that is closer than `gap` in the scene's units of gaps.
  void find(BodyColumns state, const std::vector<std::pair<int, int>>& pairs, double gap,
            std::vector<ContactPoint>& out);
  // The contact at the same place in another state: the same feature, or the nearest of the pair. False if the pair has
  // none; the contact is then left as it was. The tangents turn with the normal and no further.
  bool follow(BodyColumns state, ContactPoint& contact);
  // Whether it is one of the four points on which the end of a cylinder lies flat on a plane.
  bool is_of_flat_end(BodyColumns state, const ContactPoint& contact) const;
  // Whether a cylinder may touch a plane.
  bool has_rims(int a, int b) const;

 private:
  const std::vector<std::pair<int, int>>& overlapping_boxes();
  void place(BodyColumns state, const ManifoldPoint& point, ContactPoint& contact) const;
  void sharpen_normals(BodyColumns state, const Collider& a, const Collider& b);
  void sharpen_rims(BodyColumns state, const Collider& of, const Plane& ground, double side);
  bool is_past_end(BodyColumns state, const ManifoldPoint& point, int a, int b) const;
  ContactPoint limit_at(BodyColumns state, std::size_t k) const;

  ContactScales scales_;
  std::vector<Collider> colliders_;
  ContactLaws laws_;
  JointLimits limits_;
  BroadPhase broad_phase_;
  std::vector<Aabb> boxes_;
  std::vector<std::pair<int, int>> pairs_;
  Manifold manifold_;
};

}  // namespace rigor::inline dynamics
