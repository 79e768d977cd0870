#include "adapters/simbody/simbody_reactions.h"

#include "adapters/common/spanning_tree.h"

namespace rigor::inline adapters {
namespace {

// The point that a joint's couple is about. Without an anchor it is the body's own centre.
Vec3 arm_of(const Scene& scene, const Joint& joint, int body) {
  const BodyPose pose = scene.pose(body);
  Vec3 arm = Vec3::Zero();
  for_each_vector(joint.type, [&](const char*, JointVector kind, const Vec3& vector) {
    if (kind == JointVector::point) arm = pose.orientation.conjugate() * (vector - pose.position);
    if (kind == (joint.a == body ? JointVector::point_of_a : JointVector::point_of_b)) arm = vector;
  });
  return arm;
}

Vec3 from_simbody(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }

}  // namespace

SimbodyReactions::SimbodyReactions(const SimbodySystem& system) : system_(system), held_(system.scene().joints.size()) {
  const Scene& scene = system.scene();
  const SpanningTree tree = spanning_tree(scene);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const int joint = tree.links[i].joint, body = static_cast<int>(i);
    if (scene.bodies[i].fixed || joint < 0) continue;
    held_[static_cast<std::size_t>(joint)].body = body;
    hanging_.emplace_back(joint, HangingJoint(scene, joint, body));
  }
  for (const SimbodySystem::Loop& loop : system.loops()) held_[static_cast<std::size_t>(loop.joint)].body = loop.body;
  for (std::size_t k = 0; k < held_.size(); ++k)
    if (held_[k].body != kWorld) held_[k].arm = arm_of(scene, scene.joints[k], held_[k].body);
}

SimbodyReactions::Instant SimbodyReactions::at(const SimTK::State& state) const {
  Instant instant(held_.size());
  const auto add = [&](int joint, const SimTK::MobilizedBody& body, const Vec3& force, const Vec3& torque) {
    const Vec3& arm = held_[static_cast<std::size_t>(joint)].arm;
    const Vec3 in_W = from_simbody(body.getBodyRotation(state) * SimTK::Vec3(arm.x(), arm.y(), arm.z()));
    Carried& carried = instant[static_cast<std::size_t>(joint)];
    carried.force += force, carried.couple += torque - in_W.cross(force);
  };
  SimTK::Vector_<SimTK::SpatialVec> at_joints;  // torque and force on the body, at its joint's frame, in W
  system_.matter().calcMobilizerReactionForces(state, at_joints);
  for (const auto& [joint, hanging] : hanging_) {
    const SimTK::MobilizedBody& body = system_.body(hanging.body());
    const SimTK::SpatialVec& carried = at_joints[body.getMobilizedBodyIndex()];
    const Vec3 arm = from_simbody(body.getBodyRotation(state) * body.getOutboardFrame(state).p()),
               force = from_simbody(carried[1]);
    add(joint, body, force, from_simbody(carried[0]) + arm.cross(force));
  }
  for (const SimbodySystem::Loop& loop : system_.loops()) {
    const SimTK::MobilizedBody& body = system_.body(loop.body);
    for (SimTK::ConstraintIndex c = loop.first; c < loop.end; ++c) {
      const SimTK::Constraint& constraint = system_.matter().getConstraint(c);
      const SimTK::Vector_<SimTK::SpatialVec> on = constraint.getConstrainedBodyForcesAsVector(state);
      for (SimTK::ConstrainedBodyIndex b(0); b < constraint.getNumConstrainedBodies(); ++b) {
        // A constraint's forces stand on the other side of Simbody's equations: they act the other way round.
        if (constraint.getMobilizedBodyFromConstrainedBody(b).getMobilizedBodyIndex() == body.getMobilizedBodyIndex())
          add(loop.joint, body, -from_simbody(on[b][1]), -from_simbody(on[b][0]));
      }
    }
  }
  return instant;
}

std::vector<ReportedReaction> SimbodyReactions::reported(const Instant& mean, BodyColumns start) const {
  std::vector<ReportedReaction> reactions(held_.size());
  for (std::size_t k = 0; k < held_.size(); ++k) {
    const Held& held = held_[k];
    if (held.body == kWorld) continue;
    const Vec3 arm = start.orientation(static_cast<std::size_t>(held.body)) * held.arm;
    reactions[k] = {held.body, mean[k].force, mean[k].couple + arm.cross(mean[k].force)};
  }
  for (const auto& [joint, hanging] : hanging_) {
    ReportedReaction& of = reactions[static_cast<std::size_t>(joint)];
    of = hanging.reaction(start, of.force, of.torque);
  }
  return reactions;
}

}  // namespace rigor::inline adapters
