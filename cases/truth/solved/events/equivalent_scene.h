// The same motion in other units, mirrored, turned about the origin, or with its bodies in reverse order. A solver that
// breaks ties by the order of bodies, prefers a direction or has thresholds in absolute units moves it differently.
#pragma once

#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline truth {

// Applied in this order.
struct Equivalence {
  bool is_mirrored = false;  // x becomes -x; not with surfaces of triangles
  Quat turn = Quat::Identity();
  bool is_reversed = false;               // the order of the bodies
  double length = 1, time = 1, mass = 1;  // new units: each length, time and mass is multiplied by these
};

Scene equivalent(Scene scene, const Equivalence& how);

// The state of the equivalent scene for one of the original, and back.
void to_equivalent(const Equivalence& how, BodyColumns original, MutableBodyColumns out);
void to_original(const Equivalence& how, BodyColumns equivalent, MutableBodyColumns out);

}  // namespace rigor::inline truth
