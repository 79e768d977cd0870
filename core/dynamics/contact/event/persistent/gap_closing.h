// Moves bodies so that nothing overlaps, for the method `event`. Mass-weighted projections close the gaps and overlaps
// that a step leaves. If there are too many points, or bodies without room, each two bodies are separated alone, sweep
// after sweep. Velocities do not change.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "core/dynamics/contact/event/mass_weighted_projection.h"
#include "core/dynamics/contact/event/persistent/persistent_forces.h"

namespace rigor::inline dynamics {

class GapClosing {
 public:
  // All must outlive it; `joints` may be null.
  GapClosing(const System& system, Joints* joints, ContactPoints& contact_points, MassWeightedProjection& projection)
      : system_(system), joints_(joints), contact_points_(contact_points), projection_(projection) {}

  // So that those of `points` that carry a force have no gap, either. Returns whether any body had to move.
  bool close(MutableBodyColumns state, const std::vector<std::pair<int, int>>& pairs,
             std::span<const PersistentPoint> points);
  // The point at which the last close() left two bodies deep in each other, because they have no room; null if there is
  // none.
  const ContactPoint* jam() const;

 private:
  void part_one_by_one(MutableBodyColumns state);

  const System& system_;
  Joints* joints_;
  ContactPoints& contact_points_;
  MassWeightedProjection& projection_;
  std::vector<ContactPoint> open_;
  ContactPoint deepest_{};  // of the points that the last close() left open
  std::vector<Vec3> moved_;
  std::vector<ProjectionTarget> targets_;
};

}  // namespace rigor::inline dynamics
