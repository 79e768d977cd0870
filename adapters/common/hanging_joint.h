// The load of a tree's joint on its child body, for an engine in joint coordinates. The engine reports the whole
// transmitted load, including springs, dampers and motors along the joint's free axis. These are subtracted, because
// they are loads and not reactions.
#pragma once

#include <optional>

#include "core/dynamics/model/joint_coordinate.h"
#include "core/engine/capabilities.h"

namespace rigor::inline adapters {

class HangingJoint {
 public:
  HangingJoint(const Scene& scene, int joint, int body);

  int body() const { return body_; }
  // The part of the load on the body, at the bodies' poses of the step's start: force [N] and torque about its centre
  // [N m], in W.
  ReportedReaction reaction(BodyColumns start, Vec3 force, Vec3 torque) const;

 private:
  int body_;
  std::optional<JointCoordinate> coordinate_;  // of a hinge or slider
  Vec3 anchor_ = Vec3::Zero();                 // m, in the body's frame: where a hinge's couple is asked for
};

}  // namespace rigor::inline adapters
