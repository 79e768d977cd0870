// What the joint of a tree puts on the body that hangs by it, of an engine in the joints' coordinates. What such an
// engine says passes there is all of it, also what springs, dampers and motors do along the joint's free axis: that is
// taken away, for they are loads and no reactions (reported_reactions.h).
#pragma once

#include <optional>

#include "core/dynamics/model/joint_coordinate.h"
#include "core/engine/capabilities.h"

namespace rigor {

class HangingJoint {
 public:
  HangingJoint(const Scene& scene, int joint, int body);

  int body() const { return body_; }
  // Of what passes to the body, at the bodies of the step's start: force [N] and torque about its centre [N m], in W.
  ReportedReaction reaction(BodyColumns start, Vec3 force, Vec3 torque) const;

 private:
  int body_;
  std::optional<JointCoordinate> coordinate_;  // of a hinge or slider
  Vec3 anchor_ = Vec3::Zero();                 // m, in the body's frame: where a hinge's couple is asked for
};

}  // namespace rigor
