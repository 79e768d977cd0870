#include "adapters/bullet/bullet_link_shapes.h"

#include "adapters/bullet/bullet_pair_laws.h"

namespace rigor::inline adapters::bullet {
namespace {

constexpr int kTouchesAll = -1, kTouchesNone = 0;

int body_of(const btBroadphaseProxy& proxy) {
  return static_cast<const btCollisionObject*>(proxy.m_clientObject)->getUserIndex();
}

}  // namespace

bool LinkShapes::SceneRule::needBroadphaseCollision(btBroadphaseProxy* a, btBroadphaseProxy* b) const {
  const bool both = (a->m_collisionFilterGroup & b->m_collisionFilterMask) != 0 &&
                    (b->m_collisionFilterGroup & a->m_collisionFilterMask) != 0;
  return both && laws.may_touch(body_of(*a), body_of(*b));
}

void LinkShapes::enter(btMultiBodyDynamicsWorld& world) {
  install_pair_laws();
  world.getPairCache()->setOverlapFilterCallback(&rule_);
}

void LinkShapes::leave(btMultiBodyDynamicsWorld& world) {
  for (const auto& collider : colliders_) world.removeCollisionObject(collider.get());
  for (const auto& body : fixed_) world.removeRigidBody(body.get());
}

btMultiBodyLinkCollider& LinkShapes::add(btMultiBodyDynamicsWorld& world, btMultiBody& tree, int link,
                                         btCollisionShape& shape, int mask) {
  colliders_.push_back(std::make_unique<btMultiBodyLinkCollider>(&tree, link));
  btMultiBodyLinkCollider& collider = *colliders_.back();
  collider.setCollisionShape(&shape);
  collider.setActivationState(DISABLE_DEACTIVATION);
  if (link < 0) {
    tree.setBaseCollider(&collider);
  } else {
    tree.getLink(link).m_collider = &collider;
  }
  world.addCollisionObject(&collider, mask == kTouchesNone ? kTouchesNone : btBroadphaseProxy::DefaultFilter, mask);
  return collider;
}

void LinkShapes::add_moving(btMultiBodyDynamicsWorld& world, const Body& body, int index, const PrincipalFrame& frame,
                            btMultiBody& tree, int link, bool has_margins) {
  has_shapes_ = true;
  btMultiBodyLinkCollider& collider =
      add(world, tree, link, *add_shape(*body.shape, frame, has_margins, shapes_), kTouchesAll);
  follow_laws(collider, laws_, index);
}

void LinkShapes::add_fixed(btMultiBodyDynamicsWorld& world, const Body& body, int index, bool has_margins) {
  btCollisionShape* shape = add_shape(*body.shape, PrincipalFrame{}, has_margins, shapes_);
  constexpr double kFixed = 0;  // kg, as Bullet has it
  btRigidBody::btRigidBodyConstructionInfo start(kFixed, nullptr, shape);
  start.m_startWorldTransform.setIdentity();
  if (!std::holds_alternative<Plane>(*body.shape))  // a plane is given in W
    start.m_startWorldTransform = btTransform(to_bullet(body.orientation), to_bullet(body.position));
  fixed_.push_back(std::make_unique<btRigidBody>(start));
  follow_laws(*fixed_.back(), laws_, index);
  if (!has_margins && surface_in(*body.shape)) adjust_contacts(*fixed_.back());
  world.addRigidBody(fixed_.back().get(), btBroadphaseProxy::DefaultFilter, kTouchesAll);
}

void LinkShapes::complete(btMultiBodyDynamicsWorld& world, btMultiBody& tree) {
  if (!tree.hasFixedBase() && !tree.getBaseCollider()) add(world, tree, -1, no_shape_, kTouchesNone);
  for (int link = 0; link < tree.getNumLinks(); ++link)
    if (!tree.getLink(link).m_collider) add(world, tree, link, no_shape_, kTouchesNone);
  btAlignedObjectArray<btQuaternion> turns;
  btAlignedObjectArray<btVector3> origins;
  tree.forwardKinematics(turns, origins);
  tree.updateCollisionObjectWorldTransforms(turns, origins);
}

}  // namespace rigor::inline adapters::bullet
