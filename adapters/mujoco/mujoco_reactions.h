// What MuJoCo says that joints carry: of the trees' joints cfrc_int, which mj_rnePostConstraint fills, and of the loops
// the forces of their equalities. MuJoCo's cfrc_int leaves out what tendons do, which springs and distance joints are,
// and the torque of an equality that welds is no torque in W: of scenes with these there are no
// reports. Nor are there of rk4, which leaves the forces of its last stage, at no instant of the run.
#pragma once

#include <string>
#include <vector>

#include "adapters/common/hanging_joint.h"
#include "adapters/mujoco/mujoco_model.h"

namespace rigor {

class MujocoReactions {
 public:
  MujocoReactions(const Scene& scene, const SpanningTree& tree, const std::string& method);

  bool are_said() const { return are_said_; }
  // As Euler's and the implicit method leave the data after a step: at its start.
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

}  // namespace rigor
