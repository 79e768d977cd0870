// How far bodies and joints are from what they do not touch yet, for the method `event`: the least gap at an instant,
// and whether nothing can have met between two, however bodies swing and turn on their way (conservative_advancement.h,
// acceleration_bounds.h). Points that are in persistent contact are no news: what these let their bodies do shows at
// the end.
#pragma once

#include "core/dynamics/collision/conservative_advancement.h"
#include "core/dynamics/contact/event/persistent/persistent_contact.h"

namespace rigor {

class Clearance {
 public:
  // All must outlive it.
  Clearance(const System& system, ContactPoints& contact_points, const PersistentContact& persistent_contact)
      : contact_points_(contact_points), persistent_contact_(persistent_contact), bounds_(system) {}

  using Pairs = std::vector<std::pair<int, int>>;  // of colliders
  struct Instant {
    BodyColumns state;
    double since = 0;  // s, since the state that the way began with
  };

  // Of the accelerations on the way from one state to the other, h after it; `t` is when it begins. False if there are
  // none to be found.
  bool find_bounds(BodyColumns from, BodyColumns to, double t, double h);
  const AccelerationBounds& bounds() const { return bounds_; }

  // Whether no pair can have touched, and no joint have come to a limit, on the way that bounds were found for. Pairs
  // of `touching` have just parted: no bound on accelerations tells them apart, so their gaps are taken to bend one
  // way.
  bool all_stay_apart(const Pairs& pairs, const std::vector<ContactPoint>& touching, const Instant& from,
                      const Instant& to);
  // In the scene's units of gaps, of what is not in persistent contact. Where other points of a pair are, or touched at
  // the start of the way, what these drift is allowed to them too.
  double least_gap(const Pairs& pairs, const std::vector<ContactPoint>& touching, const Instant& at);

 private:
  struct PointGap {
    std::uint32_t feature;
    double gap, rate;  // m, m/s
  };
  bool has_just_parted(int a, int b, const std::vector<ContactPoint>& touching, double h) const;
  bool goes_on_to_part(int a, int b, const Instant& from, const Instant& to);
  void note_gaps(BodyColumns state, int a, int b, std::vector<PointGap>& out);
  bool may_have_touched_limit(const Instant& from, const Instant& to) const;
  double least_gap_of_limits(const std::vector<ContactPoint>& touching, const Instant& at) const;
  bool is_persistent_limit(std::size_t k) const;
  bool stays(int collider) const;
  Bend bend_of(const Collider& collider) const;

  std::vector<PointGap> gaps_from_, gaps_to_;
  ContactPoints& contact_points_;
  const PersistentContact& persistent_contact_;
  AccelerationBounds bounds_;
};

}  // namespace rigor
