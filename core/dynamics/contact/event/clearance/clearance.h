// The distances of bodies and joints from new contacts, for the method `event`: the smallest gap at an instant, and
// whether nothing can have met between two instants, however bodies swing and rotate on their way
// (conservative_advancement.h, acceleration_bounds.h). Points in persistent contact are excluded; motion that they
// permit is checked at the end.
#pragma once

#include "core/dynamics/collision/conservative_advancement.h"
#include "core/dynamics/contact/event/persistent/persistent_contact.h"

namespace rigor::inline dynamics {

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

  // Finds the bounds of accelerations on the way from one state at `t` to the other, h later. Returns false if there
  // are none.
  bool find_bounds(BodyColumns from, BodyColumns to, double t, double h);
  const AccelerationBounds& bounds() const { return bounds_; }

  // Whether no pair can have touched, and no joint reached a limit, on the way for which bounds were found. Pairs of
  // `touching` have just separated. No bound on accelerations can separate them, so their gaps are assumed to bend in
  // one direction.
  bool all_stay_apart(const Pairs& pairs, const std::vector<ContactPoint>& touching, const Instant& from,
                      const Instant& to);
  // In the scene's units of gaps, for pairs that are not in persistent contact. If other points of a pair are, or
  // touched at the start of the way, their drift is subtracted.
  double least_gap(const Pairs& pairs, const std::vector<ContactPoint>& touching, const Instant& at);

 private:
  struct PointGap {
    std::uint32_t feature;
    double gap, rate;  // m, m/s
  };
  bool has_just_parted(int a, int b, const std::vector<ContactPoint>& touching, double h) const;
  bool goes_on_to_part(int a, int b, const Instant& from, const Instant& to);
  bool stays_off_surface(int a, int b, const std::vector<ContactPoint>& touching, const Instant& from,
                         const Instant& to);
  void note_touched(const ContactPoint& contact, const Collider& ground, BodyColumns state);
  void note_normals(BodyColumns state, int a, int b, double side);
  void note_gaps(BodyColumns state, int a, int b, std::vector<PointGap>& out);
  bool may_have_touched_limit(const Instant& from, const Instant& to) const;
  double gap_above_surface(BodyColumns state, int a, int b) const;
  double least_gap_of_limits(const std::vector<ContactPoint>& touching, const Instant& at) const;
  bool is_persistent_limit(std::size_t k) const;
  bool stays(int collider) const;
  Bend bend_of(const Collider& collider) const;

  std::vector<PointGap> gaps_from_, gaps_to_;
  std::vector<int> touched_;   // patches of the surface at hand
  std::vector<Vec3> normals_;  // unit, in W, from that surface
  ContactPoints& contact_points_;
  const PersistentContact& persistent_contact_;
  AccelerationBounds bounds_;
};

}  // namespace rigor::inline dynamics
