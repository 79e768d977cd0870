#include "core/scene/contact_laws.h"

namespace rigor::inline scene {

ContactLaws::ContactLaws(const Scene& scene) : default_(scene.contact_default) {
  // The first row of a pair holds, as in Scene::contact_law: emplace keeps what is there.
  for (const ContactPair& pair : scene.contact_pairs) {
    laws_.emplace(key(pair.a, pair.b), pair.law);
    some_are_apart_ |= !pair.law.collides;
  }
}

bool can_meet(const Body& a, const Body& b) { return a.collides && b.collides && !(a.fixed && b.fixed); }

bool anything_can_touch(const Scene& scene) {
  std::size_t moving = 0, standing = 0, apart = 0;
  for (const Body& body : scene.bodies) {
    if (body.collides) ++(body.fixed ? standing : moving);
  }
  if (moving == 0) return false;
  for (const ContactPair& pair : scene.contact_pairs)
    apart += !pair.law.collides && can_meet(scene.bodies[pair.a], scene.bodies[pair.b]);
  return moving * (moving - 1) / 2 + moving * standing > apart;
}

}  // namespace rigor::inline scene
