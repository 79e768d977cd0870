#include "adapters/bullet/bullet_pair_laws.h"

#include <BulletCollision/CollisionDispatch/btInternalEdgeUtility.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>

#include <algorithm>

namespace rigor::inline adapters::bullet {
namespace {

// Stands for an infinite coefficient: beyond any force, and times a normal impulse of zero still zero, not "not a
// number".
constexpr btScalar kInfinite = 1e30;

CalculateCombinedCallback bullets_friction = nullptr, bullets_restitution = nullptr;

// The pair's law, or null if the two do not belong to one Rigor world.
const ContactLaw* law_of(const btCollisionObject* a, const btCollisionObject* b) {
  if (!a->getUserPointer() || a->getUserPointer() != b->getUserPointer()) return nullptr;
  return &static_cast<const ContactLaws*>(a->getUserPointer())->of(a->getUserIndex(), b->getUserIndex());
}

btScalar friction_of(const btCollisionObject* a, const btCollisionObject* b) {
  const ContactLaw* law = law_of(a, b);
  return law ? std::min(law->friction, kInfinite) : bullets_friction(a, b);
}

btScalar restitution_of(const btCollisionObject* a, const btCollisionObject* b) {
  const ContactLaw* law = law_of(a, b);
  return law ? law->restitution : bullets_restitution(a, b);
}

// Called only for objects with CF_CUSTOM_MATERIAL_CALLBACK. Bullet ignores what it returns.
bool soften(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int, const btCollisionObjectWrapper* b, int,
            int) {
  const ContactLaw* law = law_of(a->getCollisionObject(), b->getCollisionObject());
  if (!law || !law->is_soft()) return false;
  point.m_combinedContactStiffness1 = law->stiffness;
  point.m_combinedContactDamping1 = law->damping;
  point.m_contactPointFlags |= BT_CONTACT_FLAG_CONTACT_STIFFNESS_DAMPING;
  return true;
}

// On a surface the second object is a triangle of it, but Bullet may pass the two in either order.
bool adjust(btManifoldPoint& point, const btCollisionObjectWrapper* a, int part_a, int index_a,
            const btCollisionObjectWrapper* b, int part_b, int index_b) {
  const auto is_triangle = [](const btCollisionObjectWrapper* object) {
    return object->getCollisionShape()->getShapeType() == TRIANGLE_SHAPE_PROXYTYPE;
  };
  if (is_triangle(a)) btAdjustInternalEdgeContacts(point, a, b, part_a, index_a);
  if (is_triangle(b)) btAdjustInternalEdgeContacts(point, b, a, part_b, index_b);
  return soften(point, a, part_a, index_a, b, part_b, index_b);
}

}  // namespace

void install_pair_laws() {
  static const bool installed = [] {
    bullets_friction = gCalculateCombinedFrictionCallback;
    bullets_restitution = gCalculateCombinedRestitutionCallback;
    gCalculateCombinedFrictionCallback = friction_of;
    gCalculateCombinedRestitutionCallback = restitution_of;
    gContactAddedCallback = adjust;
    return true;
  }();
  static_cast<void>(installed);
}

void follow_laws(btCollisionObject& object, const ContactLaws& laws, int index) {
  object.setUserPointer(const_cast<ContactLaws*>(&laws));  // Bullet keeps it as void*; it is only read through
  object.setUserIndex(index);
}

void adjust_contacts(btCollisionObject& object) {
  object.setCollisionFlags(object.getCollisionFlags() | btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
}

}  // namespace rigor::inline adapters::bullet
