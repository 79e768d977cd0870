// A free body with two equal principal moments. L is constant, and so is the spin s = L_axis (1/I_axis - 1/I_across)
// about the symmetry axis: w = L / I_across + s axis. The body spins at the rate s about its axis, and the axis
// precesses about L at |L| / I_across, so that q = turn(L t / I_across) q0 turn(s t axis_B) (Landau and Lifshitz,
// Mechanics, 3rd ed., section 33; Kane, Likins and Levinson, Spacecraft Dynamics, 1983, section 3.1).
#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include "cases/truth/closed_form/closed_form.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

class AxisymmetricTop final : public BodyMotion {
 public:
  AxisymmetricTop(const Body& body, const Vec3& gravity) : path_(body, gravity), start_(extended(body.orientation)) {
    const ExtendedMat3 inertia = extended(body.inertia);
    const Eigen::SelfAdjointEigenSolver<ExtendedMat3> principal(inertia);
    const ExtendedVec3& moments = principal.eigenvalues();  // ascending
    const bool is_flat = moments[1] - moments[0] <= moments[2] - moments[1];
    const Extended gap = (is_flat ? moments[1] - moments[0] : moments[2] - moments[1]) / moments[2];
    if (gap > kEqualMoments) refuse(body, moments);
    const int axis = is_flat ? 2 : 0;
    const ExtendedVec3 w_B = start_.conjugate() * extended(body.angular_velocity);
    axis_ = principal.eigenvectors().col(axis).normalized();
    const Extended about_axis = moments[axis], across = (moments[1] + moments[2 - axis]) / 2;
    spin_ = w_B.dot(axis_) * (1 - about_axis / across);
    precession_ = start_ * ExtendedVec3(inertia * w_B) / across;
    gap_ = static_cast<double>(gap);
  }

  ExtendedState at(Extended t) const override {
    const ExtendedQuat q = turn(t * precession_) * start_ * turn(t * spin_ * axis_);
    return {path_.position(t), q, path_.velocity(t), precession_ + spin_ * (q * axis_)};
  }

  // Rounding shifts both phases. A difference of the equal moments also changes the spin as the body rotates.
  double error(double t) const override {
    const double turned = static_cast<double>(precession_.norm() + std::abs(spin_)) * t;
    return path_.error(t) + 4 * kExtendedEpsilon * turned + gap_ * turned * (1 + turned / 2);
  }

 private:
  [[noreturn]] static void refuse(const Body& body, const ExtendedVec3& moments) {
    throw InputError(fmt::format(
        "the truth 'axisymmetric-top' needs two equal principal moments; those of body '{}' are {:.17g}, {:.17g} and "
        "{:.17g} kg m² (take 'asymmetric-top')",
        body.name, static_cast<double>(moments[0]), static_cast<double>(moments[1]), static_cast<double>(moments[2])));
  }

  Parabola path_;
  ExtendedQuat start_;
  ExtendedVec3 axis_;        // unit, in B
  Extended spin_ = 0;        // rad/s, about the axis, beside the precession
  ExtendedVec3 precession_;  // rad/s, in W
  double gap_ = 0;           // between the equal moments, as a share of the largest
};

}  // namespace

TruthRow axisymmetric_top_truth() {
  return {"axisymmetric-top", "free bodies with two equal principal moments, in closed form",
          [](const Scene& scene, double) {
            check_needs(scene, "axisymmetric-top", "bodies in free flight");
            return closed_form(scene,
                               [&](const Body& b) { return std::make_unique<AxisymmetricTop>(b, scene.gravity); });
          }};
}

}  // namespace rigor::inline truth
