// A scene as Bullet's btMultiBody: reduced coordinates (joint angles and displacements), accelerations by
// Featherstone's articulated-body algorithm, so that joints hold to rounding. Trees only. A joint of the scene is one
// of Bullet's:
//   ball spherical    hinge revolute    slider prismatic    fixed fixed
//   universal         two revolute ones with a link between them that has neither mass nor inertia; only the inertia
//                     of all that hangs on a joint is ever divided by, and that is never zero here
// The root of a free tree is a body with six coordinates; its v and w are stepped in W. Link frames are principal
// frames, because Bullet's inertias are diagonal. Limits and motors that keep a speed are impulses of Bullet's solver
// after the accelerations. A limit stops a joint that passed it (btMultiBodyJointLimitConstraint), without rebound.
// "parent to this" maps vectors from the parent's frame.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyConstraintSolver.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointFeedback.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointLimitConstraint.h>
#include <BulletDynamics/Featherstone/btMultiBodyJointMotor.h>

#include <memory>
#include <vector>

#include "adapters/bullet/bullet_contacts.h"
#include "adapters/bullet/bullet_convert.h"
#include "adapters/bullet/bullet_link_shapes.h"
#include "adapters/bullet/bullet_links.h"
#include "adapters/bullet/bullet_tree.h"
#include "adapters/common/external_loads.h"
#include "adapters/common/hanging_joint.h"
#include "core/engine/clock.h"
#include "core/engine/engine.h"

namespace rigor::inline adapters {

class BulletMultibodyWorld : public World, public ReportsReactions, public ReportsContacts {
 public:
  BulletMultibodyWorld(const Scene& scene, const Settings& settings);
  ~BulletMultibodyWorld() override;
  BulletMultibodyWorld(const BulletMultibodyWorld&) = delete;
  BulletMultibodyWorld& operator=(const BulletMultibodyWorld&) = delete;

  void step(double dt) override;
  void read(Snapshot& out) const override;
  SettingsInForce settings_in_force() const override;
  std::string solver_warning() const override { return ""; }  // nothing is solved by iteration
  Capabilities capabilities() override { return {.reactions = this, .contacts = this}; }
  void ask_for_reactions() override;
  std::vector<ReportedReaction> reactions() const override;
  void ask_for_contacts() override {}  // Bullet always keeps them
  std::vector<ReportedContact> contacts() const override { return bullet::contacts_of(dispatcher_, last_dt_); }

 private:
  struct Row {  // a body of the scene
    bool moves = false;
    bullet::PrincipalFrame frame;
    Quat q_WP_start = Quat::Identity();
    btMultiBody* tree = nullptr;
    int link = -1;    // of the tree; -1 is its base
    BodyState state;  // as last read
  };

  struct Coordinate {  // of a hinge or slider
    btMultiBody* tree = nullptr;
    int link = -1;
    double sign = 1;  // of Bullet's, against the scene's
  };

  void add_tree(const Scene& scene, const bullet::Tree& tree, bool matched);
  void add_branch(const Scene& scene, const bullet::Branch& branch, btMultiBody& tree, int first_link);
  bullet::JointEnds ends_at_start(const Scene& scene, const bullet::Branch& branch) const;
  void add_shapes(const Scene& scene, bool matched);
  void add_limits(const Scene& scene, bool matched);
  void add_motors(const Scene& scene);
  void set_motors(double dt);
  void add_loads(double dt);
  void note_bodies();
  void read_bodies();

  std::vector<Row> rows_;
  ExternalLoads loads_;
  Clock clock_;
  double last_dt_ = 0;                                 // s
  std::vector<std::pair<int, HangingJoint>> hanging_;  // by joint
  std::vector<btMultiBodyJointFeedback> feedback_;     // of the same, once asked
  BodyTable before_;                                   // the last step, once there was one
  std::vector<std::unique_ptr<btMultiBody>> trees_;
  struct Drive {
    Motor motor;  // that keeps a speed
    std::unique_ptr<btMultiBodyJointMotor> row;
  };
  std::vector<Coordinate> coordinates_;  // by joint
  std::vector<std::unique_ptr<btMultiBodyJointLimitConstraint>> limits_;
  std::vector<Drive> drives_;
  bullet::LinkShapes shapes_;
  // by tree: bodies, base first; kWorld for links without a body of the scene
  std::vector<std::vector<int>> body_of_link_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btMultiBodyConstraintSolver solver_;
  btMultiBodyDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
};

}  // namespace rigor::inline adapters
