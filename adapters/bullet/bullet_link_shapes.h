// The shapes of bullet:multibody: a collider for each link and each floating base, and a rigid body without mass for
// each fixed body. Which pairs touch is the scene's rule alone; Bullet's own rules for links of one tree are switched
// off.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <BulletDynamics/Featherstone/btMultiBody.h>
#include <BulletDynamics/Featherstone/btMultiBodyDynamicsWorld.h>
#include <BulletDynamics/Featherstone/btMultiBodyLinkCollider.h>

#include <memory>
#include <vector>

#include "adapters/bullet/bullet_convert.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline adapters::bullet {

class LinkShapes {
 public:
  explicit LinkShapes(const Scene& scene) : laws_(scene), rule_(laws_) {}
  LinkShapes(const LinkShapes&) = delete;
  LinkShapes& operator=(const LinkShapes&) = delete;

  // From now on the world asks the scene which pairs touch.
  void enter(btMultiBodyDynamicsWorld& world);
  void leave(btMultiBodyDynamicsWorld& world);

  // `link` -1: the base. `frame`: of the link, as bullet_convert.h says. `has_margins`: as add_shape().
  void add_moving(btMultiBodyDynamicsWorld& world, const Body& body, int index, const PrincipalFrame& frame,
                  btMultiBody& tree, int link, bool has_margins);
  void add_fixed(btMultiBodyDynamicsWorld& world, const Body& body, int index, bool has_margins);
  // A collider without a shape for what has none. Bullet finds a tree's constraints by the colliders of its links, and
  // holds a tree together by colliders that follow each other.
  void complete(btMultiBodyDynamicsWorld& world, btMultiBody& tree);

  bool are_any() const { return has_shapes_; }

 private:
  struct SceneRule : btOverlapFilterCallback {
    explicit SceneRule(const ContactLaws& of_pairs) : laws(of_pairs) {}
    bool needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const override;
    const ContactLaws& laws;
  };
  btMultiBodyLinkCollider& add(btMultiBodyDynamicsWorld& world, btMultiBody& tree, int link, btCollisionShape& shape,
                               int mask);

  ContactLaws laws_;
  SceneRule rule_;
  bool has_shapes_ = false;
  Shapes shapes_;
  btEmptyShape no_shape_;
  std::vector<std::unique_ptr<btMultiBodyLinkCollider>> colliders_;
  std::vector<std::unique_ptr<btRigidBody>> fixed_;
};

}  // namespace rigor::inline adapters::bullet
