// The joint loads that MuJoCo reports: cfrc_int for joints of trees, which mj_rnePostConstraint fills, and the forces
// of equalities for loops. cfrc_int omits tendons, which are springs and distance joints. The torque of a weld equality
// is not a torque in W. Scenes with these have no reports. rk4 has none either, because it leaves the forces of its
// last stage.
#pragma once

#include <string>
#include <vector>

#include "adapters/common/hanging_joint.h"
#include "adapters/mujoco/mujoco_model.h"

namespace rigor::inline adapters {

class MujocoReactions {
 public:
  MujocoReactions(const Scene& scene, const SpanningTree& tree, const std::string& method);

  bool are_said() const { return are_said_; }
  // The data as left by a step of Euler's or the implicit method: those of the step's start.
  std::vector<ReportedReaction> after_step(const mjModel& model, mjData& data, const MujocoModel& made) const;

 private:
  struct Loop {
    int joint, body;  // its first body
    int equalities;   // one of a ball, two of a hinge
  };

  bool are_said_ = true;
  std::size_t joints_;
  std::vector<std::pair<int, HangingJoint>> hanging_;  // by joint of the scene
  std::vector<Loop> loops_;
};

}  // namespace rigor::inline adapters
