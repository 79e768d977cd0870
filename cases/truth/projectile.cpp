// Free flight under constant gravity: p = p0 + v0 t + g t²/2, and a spin that stays what it is because it is about a
// principal axis: q = rotation_by(w t) q0 (Goldstein, Classical Mechanics, 3rd ed., section 5.6: torque-free motion).
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "cases/truth/truth.h"
#include "core/error.h"
#include "core/scene/features.h"

namespace rigor {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

void check_spin(const Body& body) {
  const Mat3 R = matrix_of(body.orientation);
  const Vec3 w = R.transpose() * body.angular_velocity, torque = w.cross(body.inertia * w);
  // A scene's own rounding: the turned axis and the inertia each carry a few roundings.
  constexpr double kRoundings = 16;
  if (torque.norm() <= kRoundings * kEpsilon * w.squaredNorm() * body.inertia.norm()) return;
  throw InputError(fmt::format(
      "the truth 'projectile' needs a constant spin, about a principal axis of the inertia; body '{}' would tumble "
      "(take 'reference')",
      body.name));
}

class Projectile final : public Truth {
 public:
  explicit Projectile(const Scene& scene) : scene_(scene) {
    for (const Need& need : needs_of(scene)) {
      if (need.feature == "fixed-body") continue;
      throw InputError(fmt::format("the truth 'projectile' is for bodies in free flight; this scene has {}: {}",
                                   need.feature, need.because));
    }
    for (const Body& body : scene.bodies) {
      if (!body.fixed) check_spin(body);
    }
  }

  void at(double t, MutableBodyColumns out) const override {
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) out.set_body(i, body_at(scene_.bodies[i], t));
  }

  // A handful of roundings of each term.
  double error(double t) const override {
    double largest = 0;
    for (const Body& body : scene_.bodies) {
      if (body.fixed) continue;
      const double path = body.position.norm() + body.velocity.norm() * t + 0.5 * scene_.gravity.norm() * t * t;
      largest = std::max({largest, path, 1 + body.angular_velocity.norm() * t});
    }
    return 4 * kEpsilon * largest;
  }

 private:
  BodyState body_at(const Body& body, double t) const {
    if (body.fixed) return {body.position, body.orientation, Vec3::Zero(), Vec3::Zero()};
    return {body.position + t * body.velocity + 0.5 * t * t * scene_.gravity,
            rotation_by(t * body.angular_velocity) * body.orientation, body.velocity + t * scene_.gravity,
            body.angular_velocity};
  }

  Scene scene_;
};

}  // namespace

TruthRow projectile_truth() {
  return {"projectile", "free flight with a constant spin, in closed form",
          [](const Scene& scene, double) { return std::make_unique<Projectile>(scene); }};
}

}  // namespace rigor
