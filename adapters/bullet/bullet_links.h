// A joint of the scene as links of a btMultiBody: which of Bullet's joints it is, and the velocities that it starts
// with.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <BulletDynamics/Featherstone/btMultiBody.h>

#include "adapters/bullet/bullet_convert.h"
#include "core/scene/scene.h"

namespace rigor::inline adapters::bullet {

// A frame at t = 0: of a body that moves, principal; of the world, and of a fixed body, W.
struct LinkFrame {
  Vec3 origin = Vec3::Zero();
  Quat q = Quat::Identity();  // to W
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();

  btVector3 seen(const Vec3& direction_W) const;
};
LinkFrame frame_at_start(const Body& body, const Quat& q_WP);

struct JointEnds {
  LinkFrame child, parent;
  bool child_is_b;
};

int links_of(const Joint& joint);  // how many

struct NewLinks {
  int first, parent;  // Bullet's numbers; -1 is the base
  double mass;        // kg, of the child
  btVector3 moments;  // kg m²
};
void add_links(btMultiBody& tree, const Joint& joint, const JointEnds& ends, const NewLinks& links);

// Computed from the joint's ends in W. `link`: the child's.
void set_velocities(btMultiBody& tree, int link, const Joint& joint, const JointEnds& ends);

}  // namespace rigor::inline adapters::bullet
