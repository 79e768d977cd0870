// Free flight under constant gravity: p = p0 + v0 t + g t²/2. The spin is about a principal axis and therefore
// constant: q = rotation_by(w t) q0 (Goldstein, Classical Mechanics, 3rd ed., section 5.6: torque-free motion).
#include <fmt/format.h>

#include "cases/truth/closed_form/smooth/principal_spin.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

class Flight final : public BodyMotion {
 public:
  Flight(const Body& body, const Vec3& gravity)
      : path_(body, gravity), spin_(body, body.angular_velocity), w_(extended(body.angular_velocity)) {
    if (spin_.holds()) return;
    throw InputError(fmt::format(
        "the truth 'projectile' needs a constant spin, about a principal axis of the inertia; body '{}' would tumble "
        "(take 'asymmetric-top', 'axisymmetric-top' or 'reference')",
        body.name));
  }

  ExtendedState at(Extended t) const override {
    return {path_.position(t), spin_.orientation(w_.norm() * t), path_.velocity(t), w_};
  }
  double error(double t) const override { return path_.error(t) + spin_.error(static_cast<double>(w_.norm()) * t); }

 private:
  Parabola path_;
  PrincipalSpin spin_;
  ExtendedVec3 w_;  // rad/s, in W
};

}  // namespace

TruthRow projectile_truth() {
  return {"projectile", "free flight with a constant spin, in closed form", [](const Scene& scene, double) {
            check_needs(scene, "projectile", "bodies in free flight");
            return closed_form(scene, [&](const Body& b) { return std::make_unique<Flight>(b, scene.gravity); });
          }};
}

}  // namespace rigor::inline truth
