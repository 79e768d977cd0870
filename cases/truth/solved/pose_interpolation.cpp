#include "cases/truth/solved/pose_interpolation.h"

#include "core/base/rotation_vector.h"

namespace rigor::inline truth {
namespace {

struct Cubic {
  Vec3 value, rate;
};
Cubic hermite(const Vec3& p0, const Vec3& v0, const Vec3& p1, const Vec3& v1, double h, double s) {
  const Vec3 a = h * v0, b = 3 * (p1 - p0) - h * (2 * v0 + v1), c = 2 * (p0 - p1) + h * (v0 + v1);
  return {p0 + s * (a + s * (b + s * c)), (a + s * (2 * b + 3 * s * c)) / h};
}

}  // namespace

BodyState between(const BodyState& from, const BodyState& to, double h, double s) {
  const Cubic path = hermite(from.position, from.velocity, to.position, to.velocity, h, s);
  const Vec3 turn = rotation_vector_of(to.orientation * from.orientation.conjugate());
  const Cubic turning =
      hermite(Vec3::Zero(), from.angular_velocity, turn, rate_of_rotation_vector(turn, to.angular_velocity), h, s);
  return {path.value, (rotation_by(turning.value) * from.orientation).normalized(), path.rate,
          left_jacobian(turning.value) * turning.rate};
}

}  // namespace rigor::inline truth
