// Velocities advanced to the time of the positions. The velocities of a semi-implicit step belong half a step before
// the positions. Raw energies therefore oscillate by the difference of both instants, which is an effect of sampling
// and no loss (Hairer, Lubich, Wanner, Geometric Numerical Integration, 2nd ed., section I.3.1: Störmer-Verlet).
#pragma once

#include <optional>

#include "cases/metrics/measures/joints/joint_reactions.h"
#include "core/dynamics/model/system.h"
#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor {

class Synchroniser {
 public:
  // `stagger`: steps by which the velocities are behind, see MethodInfo::leapfrog_stagger.
  Synchroniser(const Scene& scene, double dt, double stagger);

  // v + stagger dt v' and w + stagger dt w', with the scene's own accelerations at the bodies' positions and time; then
  // to the nearest velocities that the joints allow there, for a joint turns velocities as the bodies go on.
  void apply(double time, MutableBodyColumns bodies);

 private:
  System system_;
  double advance_;  // s
  Wrenches wrenches_;
  std::optional<JointReactions> joints_;  // where there are any, and velocities to bring forward
};

}  // namespace rigor
