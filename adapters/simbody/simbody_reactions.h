// The joint loads that Simbody reports: reactions of its mobilizers, and forces of the constraints that close loops.
// Both belong to an instant; the value of a step is the mean of both ends. Compiled like simbody_system.h.
#pragma once

#include <vector>

#include "adapters/common/hanging_joint.h"
#include "adapters/simbody/simbody_system.h"

namespace rigor::inline adapters {

class SimbodyReactions {
 public:
  explicit SimbodyReactions(const SimbodySystem& system);

  // One per joint: a force [N], and a couple about the joint's point [N m], on one of its bodies; in W.
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

}  // namespace rigor::inline adapters
