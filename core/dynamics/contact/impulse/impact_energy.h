// No impact adds energy. Newton's restitution at several points of a body, or with friction, may (Kane's paradox): then
// the velocities go only so far from those without restitution to those with it, (1 - s) V + s V', that the kinetic
// energy is what it was before the impacts.
#pragma once

#include "core/dynamics/model/system.h"
#include "core/engine/columns.h"

namespace rigor {

class ImpactEnergy {
 public:
  explicit ImpactEnergy(const System& system) : system_(system) {}

  // The bodies' records of velocities (kernels.h): before the impacts, without restitution, and with it, which is
  // changed. All at the pose of `state`.
  void remember_before(BodyColumns state, const AlignedDoubles& velocities) {
    before_ = product(state, velocities, velocities);
  }
  void remember_without_restitution(const AlignedDoubles& velocities) { without_ = velocities; }
  void limit(BodyColumns state, AlignedDoubles& velocities);

 private:
  // V·M V', twice the energy where both are the same [J].
  double product(BodyColumns state, const AlignedDoubles& a, const AlignedDoubles& b) const;

  const System& system_;
  double before_ = 0;
  AlignedDoubles without_, change_;
};

}  // namespace rigor
