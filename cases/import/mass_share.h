// Splits a rigid body in two: a part of even density in a given shape, and the rest.
#pragma once

#include <optional>

#include "core/scene/link_model.h"

namespace rigor {

struct MassShare {
  double mass;        // kg, of the part
  LinkInertial rest;  // about its own centre of mass; in the axes of the whole
};

// Takes the largest part whose rest is still a body that matter can make. Parts are powers of two, at most `most` of
// the whole. Returns nothing if even a thousandth is too much.
std::optional<MassShare> take_share(const LinkInertial& whole, const Shape& shape, const BodyPose& at, double most);

}  // namespace rigor
