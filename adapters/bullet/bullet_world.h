// A scene as Bullet's own objects: a btRigidBody for each body that moves, and for each fixed one that collides.
#pragma once

#include <BulletDynamics/MLCPSolvers/btDantzigSolver.h>
#include <BulletDynamics/MLCPSolvers/btMLCPSolver.h>
#include <btBulletDynamicsCommon.h>

#include <memory>
#include <string>
#include <vector>

#include "adapters/bullet/bullet_contacts.h"
#include "adapters/bullet/bullet_convert.h"
#include "adapters/bullet/bullet_joints.h"
#include "adapters/common/external_loads.h"
#include "core/engine/clock.h"
#include "core/engine/saved_bytes.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline adapters {

class BulletWorld : public World, public ReportsReactions, public ReportsContacts, public ArchivesState {
 public:
  BulletWorld(const Scene& scene, const Settings& settings);
  BulletWorld(const BulletWorld&) = delete;
  BulletWorld& operator=(const BulletWorld&) = delete;

  void step(double dt) override;
  void read(Snapshot& out) const override;
  SettingsInForce settings_in_force() const override;
  std::string solver_warning() const override { return warning_; }
  Capabilities capabilities() override { return {.reactions = this, .contacts = this, .state = this}; }
  void ask_for_reactions() override { joints_->ask_for_reactions(); }
  std::vector<ReportedReaction> reactions() const override;
  void ask_for_contacts() override {}  // Bullet always keeps them
  std::vector<ReportedContact> contacts() const override { return bullet::contacts_of(dispatcher_, last_dt_); }

 private:
  struct Row {
    std::unique_ptr<btRigidBody> body;  // null for a fixed body that touches nothing
    bool moves = false;
    bool turned = false;           // whether Bullet's frame P is not the body frame B
    Mat3 R_PB = Mat3::Identity();  // B to P
    BodyState standing;            // of a fixed body
  };

  void archive_state(StateArchive& archive) override;
  void apply(const Settings& settings);
  void match(const Scene& scene, const Settings& settings);
  void keep_apart(const Scene& scene);
  btRigidBody& end_of_joint(int body);
  void look_for_fallback();
  void add_body(const Body& body, const Settings& settings);
  void add_loads(double dt);
  const btRigidBody* first_moving() const;
  std::string restitution_in_words() const;

  ContactLaws laws_;
  ExternalLoads loads_;
  bool matched_, bounces_, is_soft_;
  double softness_ = 0;  // 1/kg: CFM/dt where it follows the step
  Clock clock_;
  double last_dt_ = 0;  // s
  std::string warning_;

  // In the order in which Bullet needs them: each outlives those below it.
  bullet::Shapes shapes_;
  btEmptyShape no_shape_;  // Bullet moves only bodies that have a shape
  std::vector<Row> rows_;
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btDantzigSolver dantzig_;
  std::unique_ptr<btSequentialImpulseConstraintSolver> solver_;
  // The anchor of joints to the world. It is not in the world's list of bodies, and so has no contacts.
  btRigidBody ground_{btRigidBody::btRigidBodyConstructionInfo(0, nullptr, &no_shape_)};
  std::unique_ptr<bullet::Joints> joints_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, solver_.get(), &configuration_};
};

}  // namespace rigor::inline adapters
