#include "cases/import/mass_share.h"

#include "core/scene/validate.h"

namespace rigor {
namespace {

// The inertia of a point mass at `offset` about the origin (Steiner).
Mat3 steiner(double mass, const Vec3& offset) {
  return mass * (offset.squaredNorm() * Mat3::Identity() - offset * offset.transpose());
}

LinkInertial rest_of(const LinkInertial& whole, double part, const Shape& shape, const BodyPose& at) {
  const BodyPose in_whole = inverse(whole.pose) * at;
  const Mat3 turn = matrix_of(in_whole.orientation);
  const double mass = whole.mass - part;
  const Vec3 centre = -part / mass * in_whole.position;  // the common centre of mass is the origin
  const Mat3 of_part = turn * inertia_of(shape, part) * turn.transpose() + steiner(part, in_whole.position);
  const Mat3 inertia = whole.inertia - of_part - steiner(mass, centre);
  return {mass, whole.pose * BodyPose{centre, Quat::Identity()}, (inertia + inertia.transpose()) / 2};
}

// Whether matter can have this inertia, with a margin of a hundredth against rounding.
bool can_be(const Mat3& inertia) {
  const double trace = inertia.trace();
  return why_no_inertia(inertia - 0.005 * trace * Mat3::Identity()).empty();
}

}  // namespace

std::optional<MassShare> take_share(const LinkInertial& whole, const Shape& shape, const BodyPose& at, double most) {
  constexpr double kLeast = 1.0 / 1024;  // below, what solves joints would feel the ratio of the masses
  for (double part = 0.5; part >= kLeast; part /= 2) {
    if (part > most) continue;
    const LinkInertial rest = rest_of(whole, part * whole.mass, shape, at);
    if (can_be(rest.inertia)) return MassShare{part * whole.mass, rest};
  }
  return {};
}

}  // namespace rigor
