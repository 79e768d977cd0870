#include "core/scene/contact_laws.h"

#include <algorithm>

namespace rigor {

ContactLaws::ContactLaws(const Scene& scene) : default_(scene.contact_default) {
  // The first row of a pair holds, as in Scene::contact_law: emplace leaves what is there.
  for (const ContactPair& pair : scene.contact_pairs) laws_.emplace(key(pair.a, pair.b), pair.law);
}

bool anything_can_touch(const Scene& scene) {
  const auto& bodies = scene.bodies;
  const auto colliding = std::count_if(bodies.begin(), bodies.end(), [](const Body& b) { return b.collides; });
  const bool some_can_move =
      std::any_of(bodies.begin(), bodies.end(), [](const Body& b) { return b.collides && !b.fixed; });
  return colliding >= 2 && some_can_move;
}

}  // namespace rigor
