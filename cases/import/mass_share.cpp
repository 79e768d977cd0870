#include "cases/import/mass_share.h"

#include <Eigen/Eigenvalues>

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

// The second moments of the mass, kg m²: matter has none below zero.
Mat3 second_moments(const Mat3& inertia) { return 0.5 * inertia.trace() * Mat3::Identity() - inertia; }

// Whether the rest keeps a hundredth of the whole's second moments in every direction. A limit relative to the whole
// suits needles and plates too, which are near the triangle inequality themselves.
bool can_be(const Mat3& rest, const Mat3& whole) {
  constexpr double kLeastShare = 0.01;
  const Mat3 spare = second_moments(rest) - kLeastShare * second_moments(whole);
  return Eigen::SelfAdjointEigenSolver<Mat3>(spare, Eigen::EigenvaluesOnly).eigenvalues().minCoeff() > 0;
}

}  // namespace

std::optional<MassShare> take_share(const LinkInertial& whole, const Shape& shape, const BodyPose& at, double most) {
  constexpr double kLeast = 1.0 / 1024;  // smaller parts would strain the solvers of joints
  for (double part = 0.5; part >= kLeast; part /= 2) {
    if (part > most) continue;
    const LinkInertial rest = rest_of(whole, part * whole.mass, shape, at);
    if (can_be(rest.inertia, whole.inertia)) return MassShare{part * whole.mass, rest};
  }
  return {};
}

}  // namespace rigor
