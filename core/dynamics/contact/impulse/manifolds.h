// The contact constraints of many bodies from one update to the next, for the method `impulse`: pairs that may meet
// until then (speculative contacts), the points of each, and the impulses of those that persist. A body's pairs are
// searched again only after it has left the fat box of its last search. A pile at rest needs no search.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/thread_pool.h"
#include "core/dynamics/collision/broad_phase.h"
#include "core/dynamics/contact/impulse/canonical_order.h"
#include "core/dynamics/kernels/contact_kernels.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline engine {
class StateArchive;
}

namespace rigor::inline dynamics {

// A contact point of two bodies that touch, or may meet before the next update; then it is where they will. Impulses
// are those of one sub-step.
struct ContactConstraint {
  int a, b;  // bodies
  std::uint32_t feature;
  bool is_deep;  // a deep overlap that was there from the start
  double friction, restitution;
  Vec3 normal;                           // unit, in W, from b to a
  Vec3 arm_a, arm_b;                     // m, in W, from each body's centre of mass to its point
  double gap;                            // m
  double normal_impulse = 0;             // N s
  Vec3 friction_impulse = Vec3::Zero();  // N s, in W
  double rest_overlap = 0;               // m: see ContactRowLayout::carry_without_overlap()

  template <typename Archive>
  void archive_state(Archive& archive) {
    archive(a, b, feature, is_deep, friction, restitution, normal, arm_a, arm_b, gap, normal_impulse, friction_impulse,
            rest_overlap);
  }
};

class Manifolds {
 public:
  // The threads share the bodies, and then the pairs.
  Manifolds(const Scene& scene, ThreadPool& threads)
      : threads_(threads),
        parts_(threads.members()),
        colliders_(in_canonical_order(scene, colliders_of(scene))),
        axes_(mirrored_axes(scene, colliders_)),
        laws_(scene),
        poses_(colliders_.size(), {Vec3::Zero(), Mat3::Identity()}),
        boxes_(colliders_.size()),
        places_(colliders_.size()),
        has_left_(colliders_.size()),
        overlaps_at_start_(scene.bodies.size()) {
    rank_.resize(scene.bodies.size());
    for (std::size_t i = 0; i < colliders_.size(); ++i)
      rank_[static_cast<std::size_t>(colliders_[i].body)] = static_cast<int>(i);
    for (const Body& body : scene.bodies) names_.push_back(body.name);
    for (const Collider& collider : colliders_) kinds_.push_back(kind_of(collider.shape));
  }

  // The constraints for the next dt, sorted by pair, with the impulses of those that persist from the last update.
  std::vector<ContactConstraint>& find(BodyColumns state, double dt);
  // Two bodies that have come to overlap deeply; empty if there are none.
  std::string failure() const;
  void archive_state(StateArchive& archive);

 private:
  enum class Kind : char { ball, plane, other };
  static Kind kind_of(const Shape& shape) {
    return std::holds_alternative<Sphere>(shape)  ? Kind::ball
           : std::holds_alternative<Plane>(shape) ? Kind::plane
                                                  : Kind::other;
  }
  static constexpr std::size_t kBatch = 256;  // pairs that are looked at together
  // The results of one thread: the constraints of some of the pairs, in their order.
  struct Part {
    Manifold manifold;
    std::array<std::int32_t, kBatch> near;  // of a batch of pairs, those that are
    std::array<BallContacts, kBatch / kRowsPerBlock> ball_contacts;
    std::vector<ContactConstraint> constraints;
    std::string failure;
  };
  // All that most pairs are judged by, in one cache line.
  struct alignas(64) Place {
    Vec3 p;        // m
    double reach;  // m, from the centre, of all that the body can get to within dt
    Vec3 v;        // m/s
    double inradius;
  };
  void place_body(std::size_t i, BodyColumns state, double dt);
  bool stay_apart(int a, int b) const;
  void update_pairs(BodyColumns state, double dt);
  void add_pairs(std::size_t first, std::size_t last, BodyColumns state, double dt, Part& part);
  void add_pair(BodyColumns state, double dt, const Collider& a, const Collider& b, Part& part);
  void add_balls(int a, int b, const BallContacts& contacts, std::size_t k, Part& part);
  void add_coincident_balls(double dt, int a, int b, Part& part);
  void add_ball_on_plane(double dt, int ball, int plane, Part& part);
  void add_round(const Collider& a, const Collider& b, const Vec3& normal, const Vec3& arm_a, const Vec3& arm_b,
                 double gap, Part& part);
  // The points of the i-th near pair of a batch.
  void add_points_of(std::size_t i, const std::pair<int, int>& pair, BodyColumns state, double dt, Part& part);
  bool is_parted_from_start(const Collider& a, const Collider& b, double gap) const;
  void watch(const Collider& a, const Collider& b, double gap, Part& part);
  std::pair<int, int> ranks_of(const ContactConstraint& point) const {
    return {rank_[static_cast<std::size_t>(point.a)], rank_[static_cast<std::size_t>(point.b)]};
  }
  void match_impulses(const std::pair<int, int>& pair, std::size_t first, Part& part, std::size_t& old) const;
  void join(std::size_t thread);

  ThreadPool& threads_;
  std::vector<Part> parts_;  // by thread
  std::vector<Collider> colliders_;
  std::vector<Vec3> axes_;   // by collider, see mirrored_axes()
  std::vector<int> rank_;    // by body: its collider
  std::vector<Kind> kinds_;  // by collider
  ContactLaws laws_;
  BroadPhase broad_phase_;
  std::vector<Pose> poses_;
  std::vector<Aabb> boxes_, fat_boxes_;
  std::vector<Place> places_;
  std::vector<char> has_left_;  // its fat box, by collider
  std::vector<int> moved_;      // those colliders
  const std::vector<std::pair<int, int>>* pairs_ = nullptr;
  bool is_first_ = true;
  std::vector<char> overlaps_at_start_;  // by body
  std::vector<std::string> names_;
  std::vector<ContactConstraint> constraints_, old_constraints_;
};

}  // namespace rigor::inline dynamics
