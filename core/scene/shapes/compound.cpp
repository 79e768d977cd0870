#include "core/scene/shapes/compound.h"

#include <algorithm>
#include <cassert>

#include "core/scene/shape_types.h"

namespace rigor::inline scene {

double Compound::volume() const {
  double sum = 0;
  for (const PlacedShape& part : parts) sum += volume_of(part.shape);
  return sum;
}

Vec3 Compound::centre() const {
  Vec3 sum = Vec3::Zero();
  for (const PlacedShape& part : parts)
    sum += volume_of(part.shape) * (part.pose.position + part.pose.orientation * centre_of(part.shape));
  return sum / volume();
}

Mat3 Compound::inertia(double mass) const {
  const double whole = volume();
  const Vec3 middle = centre();
  Mat3 sum = Mat3::Zero();
  for (const PlacedShape& part : parts) {
    const double share = mass * volume_of(part.shape) / whole;
    const Mat3 R = matrix_of(part.pose.orientation);
    const Vec3 arm = part.pose.position + R * centre_of(part.shape) - middle;
    sum += R * inertia_of(part.shape, share) * R.transpose() +
           share * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  return sum;
}

double Compound::bounding_radius() const {
  double most = 0;
  for (const PlacedShape& part : parts)
    most = std::max(most, part.pose.position.norm() + rigor::bounding_radius(part.shape));
  return most;
}

double Compound::inradius() const {
  double least = kEndless;
  for (const PlacedShape& part : parts) least = std::min(least, rigor::inradius(part.shape));
  return least;
}

Vec3 Compound::support(const Vec3& n) const {
  assert(!parts.empty());
  Vec3 best = Vec3::Zero();
  double most = -kEndless;
  for (const PlacedShape& part : parts) {
    const Vec3 at =
        part.pose.position + part.pose.orientation * rigor::support(part.shape, part.pose.orientation.conjugate() * n);
    if (n.dot(at) > most) most = n.dot(at), best = at;
  }
  return best;
}

TriangleMesh Compound::drawn() const {
  TriangleMesh mesh;
  for (const PlacedShape& part : parts) {
    TriangleMesh of_part = drawn_mesh(part.shape);
    for (Vec3& point : of_part.points) point = part.pose.orientation * point;
    for (Vec3& normal : of_part.normals) normal = part.pose.orientation * normal;
    append(mesh, of_part, part.pose.position);
  }
  return mesh;
}

}  // namespace rigor::inline scene
