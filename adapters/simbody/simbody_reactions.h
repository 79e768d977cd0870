// What Simbody says that joints carry: of its mobilizers their reactions, of the constraints that close loops what
// these put on the bodies. Both belong to an instant; over a step they are the mean of those at its ends. Compiled as
// simbody_system.h is.
#pragma once

#include <vector>

#include "adapters/common/hanging_joint.h"
#include "adapters/simbody/simbody_system.h"

namespace rigor {

class SimbodyReactions {
 public:
  explicit SimbodyReactions(const SimbodySystem& system);

  // By joint: a force [N], and a couple about the joint's point [N m], on one of its bodies; in W.
  struct Carried {
    Vec3 force = Vec3::Zero(), couple = Vec3::Zero();
  };
  using Instant = std::vector<Carried>;

  // The state must be realised to its accelerations.
  Instant at(const SimTK::State& state) const;
  // Of a step that began with `start`, over which `mean` was carried.
  std::vector<ReportedReaction> reported(const Instant& mean, BodyColumns start) const;

 private:
  struct Held {  // a joint, and the body whose reaction is asked for
    int body = kWorld;
    Vec3 arm = Vec3::Zero();  // m, from the body's centre to the joint's point, in its frame
  };

  const SimbodySystem& system_;
  std::vector<Held> held_;  // by joint
  std::vector<std::pair<int, HangingJoint>> hanging_;
};

}  // namespace rigor
