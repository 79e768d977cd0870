#include "adapters/bullet/bullet_contacts.h"

#include "adapters/bullet/bullet_convert.h"

namespace rigor::inline adapters::bullet {

// The manifolds are those of the step's start, with the impulses that the step has given them. Bullet's normal points
// from its second body to its first.
std::vector<ReportedContact> contacts_of(const btCollisionDispatcher& dispatcher, double dt) {
  std::vector<ReportedContact> contacts;
  if (dt == 0) return contacts;
  for (int m = 0; m < dispatcher.getNumManifolds(); ++m) {
    const btPersistentManifold& manifold = *dispatcher.getManifoldByIndexInternal(m);
    const int first = manifold.getBody0()->getUserIndex(), second = manifold.getBody1()->getUserIndex();
    for (int k = 0; k < manifold.getNumContacts(); ++k) {
      const btManifoldPoint& at = manifold.getContactPoint(k);
      // The solver leaves out points that are farther apart, and their impulses are those of an earlier step.
      const bool is_solved = at.getDistance() <= manifold.getContactProcessingThreshold();
      const btVector3 impulse = is_solved ? at.m_appliedImpulse * at.m_normalWorldOnB +
                                                at.m_appliedImpulseLateral1 * at.m_lateralFrictionDir1 +
                                                at.m_appliedImpulseLateral2 * at.m_lateralFrictionDir2
                                          : btVector3(0, 0, 0);
      contacts.push_back({second, first, to_rigor(at.getPositionWorldOnB()), to_rigor(at.m_normalWorldOnB),
                          at.getDistance(), to_rigor(impulse) / dt});
    }
  }
  return contacts;
}

}  // namespace rigor::inline adapters::bullet
