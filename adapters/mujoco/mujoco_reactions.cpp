#include "adapters/mujoco/mujoco_reactions.h"

#include <algorithm>

#include "adapters/mujoco/mujoco_mjcf.h"

namespace rigor::inline adapters {

namespace {

// Their poses, which are all that a reaction asks for.
BodyTable bodies_in(const mjData& data, const MujocoModel& made) {
  BodyTable bodies(made.body.size());
  for (std::size_t i = 0; i < made.body.size(); ++i) {
    if (made.body[i] < 0) continue;
    const mjtNum *p = data.xpos + 3 * made.body[i], *q = data.xquat + 4 * made.body[i];
    bodies.columns().set_position(i, {p[0], p[1], p[2]});
    bodies.columns().set_orientation(i, {q[0], q[1], q[2], q[3]});
  }
  return bodies;
}

}  // namespace

MujocoReactions::MujocoReactions(const Scene& scene, const SpanningTree& tree, const std::string& method)
    : joints_(scene.joints.size()) {
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const int joint = tree.links[static_cast<std::size_t>(i)].joint;
    if (!scene.bodies[static_cast<std::size_t>(i)].fixed && joint >= 0)
      hanging_.emplace_back(joint, HangingJoint(scene, joint, i));
  }
  are_said_ = scene.springs.empty() && scene.couplings.empty() && method != "rk4" &&
              std::none_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) {
                return joint.armature > 0 || std::holds_alternative<CompoundJoint>(joint.type) ||
                       std::holds_alternative<PlanarJoint>(joint.type) ||
                       std::holds_alternative<ScrewJoint>(joint.type);
              });
  for (const int k : tree.loops) {
    const Joint& joint = scene.joints[static_cast<std::size_t>(k)];
    const MjcfLoop loop = mjcf_loop(joint);
    are_said_ = are_said_ && loop.equality == MjcfLoop::Equality::connect;
    loops_.push_back({k, joint.a != kWorld ? joint.a : joint.b, static_cast<int>(loop.points.size())});
  }
}

// cfrc_int is the torque and force on a body from its parent, in W, with the torque about the centre of mass of the
// whole tree. An equality's rows are the three components in W of the force on its point of the first body.
std::vector<ReportedReaction> MujocoReactions::after_step(const mjModel& model, mjData& data,
                                                          const MujocoModel& made) const {
  mj_rnePostConstraint(&model, &data);
  const BodyTable bodies = bodies_in(data, made);
  std::vector<ReportedReaction> reactions(joints_);
  for (const auto& [joint, hanging] : hanging_) {
    const int id = made.body[static_cast<std::size_t>(hanging.body())];
    const Eigen::Map<const Vec3> torque(data.cfrc_int + 6 * id), force(data.cfrc_int + 6 * id + 3);
    const Vec3 about = Eigen::Map<const Vec3>(data.subtree_com + 3 * model.body_rootid[id]),
               centre = Eigen::Map<const Vec3>(data.xipos + 3 * id);
    reactions[static_cast<std::size_t>(joint)] =
        hanging.reaction(bodies.columns(), force, torque + (about - centre).cross(Vec3(force)));
  }
  std::vector<int> first_row(static_cast<std::size_t>(model.neq), -1);
  for (int row = data.nefc - 1; row >= 0; --row)
    if (data.efc_type[row] == mjCNSTR_EQUALITY) first_row[static_cast<std::size_t>(data.efc_id[row])] = row;
  int equality = 0;
  for (const Loop& loop : loops_) {
    ReportedReaction& reaction = reactions[static_cast<std::size_t>(loop.joint)];
    reaction.body = loop.body;
    const int id = made.body[static_cast<std::size_t>(loop.body)];
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> R(data.xmat + 9 * id);
    for (int n = 0; n < loop.equalities; ++n, ++equality) {
      const Vec3 force = Eigen::Map<const Vec3>(data.efc_force + first_row[static_cast<std::size_t>(equality)]),
                 arm = R * Eigen::Map<const Vec3>(model.eq_data + mjNEQDATA * equality);
      reaction.force += force, reaction.torque += arm.cross(force);
    }
  }
  return reactions;
}

}  // namespace rigor::inline adapters
