// A rigid body as two: a part that a given shape of even density makes, and the rest.
#pragma once

#include <optional>

#include "core/scene/link_model.h"

namespace rigor {

struct MassShare {
  double mass;        // kg, of the part
  LinkInertial rest;  // about its own centre of mass; in the axes of the whole
};

// The largest part, a power of two and at most `most` of the whole, whose rest still is a body that matter can make;
// none if there is no such part down to a thousandth.
std::optional<MassShare> take_share(const LinkInertial& whole, const Shape& shape, const BodyPose& at, double most);

}  // namespace rigor
