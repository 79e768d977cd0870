// Volume, centre of mass and inertia of what triangles enclose, as sums over tetrahedra from a point to the triangles.
// These are Mirtich's integrals (Fast and Accurate Computation of Polyhedral Mass Properties, 1996), exact for
// polynomials.
#pragma once

#include "core/base/math.h"

namespace rigor::inline scene {

class SolidIntegrals {
 public:
  explicit SolidIntegrals(const Vec3& origin) : origin_(origin) {}

  // A triangle, anticlockwise as seen from outside.
  void add(const Vec3& p, const Vec3& q, const Vec3& r) {
    const Vec3 a = p - origin_, b = q - origin_, c = r - origin_, sum = a + b + c;
    const double six = a.dot(b.cross(c));  // six volumes
    volume_ += six / 6;
    first_ += six / 24 * sum;
    second_ += six / 120 * (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }

  double volume() const { return volume_; }                         // m³; negative for triangles that look inwards
  Vec3 centre() const { return origin_ + Vec3(first_ / volume_); }  // m
  Mat3 inertia() const {                                            // m⁵, about the centre, of unit density
    const Vec3 arm = first_ / volume_;
    const Mat3 about_centre = second_ - volume_ * arm * arm.transpose();
    return about_centre.trace() * Mat3::Identity() - about_centre;
  }

 private:
  Vec3 origin_, first_ = Vec3::Zero();
  Mat3 second_ = Mat3::Zero();
  double volume_ = 0;
};

}  // namespace rigor::inline scene
