// A world whose engine says itself what its joints carry. Nobody has to offer this.
#pragma once

#include <vector>

#include "core/engine/engine.h"

namespace rigor {

// What a joint put on one of its two bodies, as a mean over the last step; in W.
struct ReportedReaction {
  int body = kWorld;           // one that moves; the other bears the opposite, at the joint
  Vec3 force = Vec3::Zero();   // N
  Vec3 torque = Vec3::Zero();  // N m, about where the body's centre of mass was at the step's start
};

class ReportsReactions {
 public:
  virtual ~ReportsReactions() = default;
  // From now on; what takes an engine time is not done unasked.
  virtual void ask_for_reactions() = 0;
  // One for each joint of the scene, in its order, since it was asked; none before the first step.
  virtual std::vector<ReportedReaction> reactions() const = 0;
};

inline void ask_for_reactions(World& world) {
  if (auto* reports = dynamic_cast<ReportsReactions*>(&world)) reports->ask_for_reactions();
}
inline std::vector<ReportedReaction> reported_reactions(const World& world) {
  const auto* reports = dynamic_cast<const ReportsReactions*>(&world);
  return reports ? reports->reactions() : std::vector<ReportedReaction>();
}

}  // namespace rigor
