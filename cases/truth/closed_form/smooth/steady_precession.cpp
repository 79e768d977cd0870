// A heavy symmetric top on a ball joint in steady precession. Its axis moves around the vertical at a constant rate and
// tilt, and the top spins at a constant rate about its axis. e points from the joint to the centre of mass, l is the
// distance, and I is about the joint. w = W + s e, where W is along gravity, and L = I w must rotate with W:
//   W x L = l e x m g,   or   W (I_axis w_axis - I_across W cos tilt) = m g l
// for a tilted top (Goldstein, Classical Mechanics, 3rd ed., section 5.7, "regular precession"). An upright one, which
// sleeps, has only the spin. So q = turn(W t) q0 turn(s t e_B).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/truth/closed_form/closed_form.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

[[noreturn]] void refuse_precession(const std::string& why) {
  throw InputError(
      "the truth 'steady-precession' is for one symmetric top on a ball joint at its axis, precessing steadily: " +
      why);
}

constexpr Extended kRoundings = 64 * static_cast<Extended>(kEpsilon);  // of the scene's numbers, relative

class SteadyPrecession final : public BodyMotion {
 public:
  SteadyPrecession(const Body& body, const ExtendedVec3& pivot, const Vec3& gravity)
      : pivot_(pivot), start_(extended(body.orientation)) {
    const ExtendedVec3 reach = extended(body.position) - pivot, w = extended(body.angular_velocity);
    length_ = reach.norm();
    if (length_ == 0) refuse_precession("the joint is at the centre of mass (take 'axisymmetric-top')");
    e_B_ = start_.conjugate() * ExtendedVec3(reach / length_);
    if ((extended(body.velocity) - w.cross(reach)).norm() > kRoundings * w.norm() * length_) {
      refuse_precession(fmt::format("the velocity of body '{}' is not what its spin about the joint gives", body.name));
    }
    const ExtendedMat3 about_joint = inertia_about_joint(body);
    split_spin(w, reach / length_, extended(gravity));
    check_steadiness(body, start_ * ExtendedVec3(about_joint * (start_.conjugate() * w)),
                     reach.cross(body.mass * extended(gravity)));
  }

  ExtendedState at(Extended t) const override {
    const ExtendedQuat q = turn(t * precession_) * start_ * turn(t * spin_ * e_B_);
    const ExtendedVec3 e = q * e_B_, w = precession_ + spin_ * e;
    return {pivot_ + length_ * e, q, w.cross(length_ * e), w};
  }

  // Rounding of the result, and of the scene: a torque error rotates L away, which then shifts the precession.
  double error(double t) const override {
    const Extended turned = (precession_.norm() + std::abs(spin_)) * t, reach = 1 + length_;
    const Extended away = misses_ * t * (1 + turned);
    return static_cast<double>(reach * (away + 4 * std::numeric_limits<Extended>::epsilon() * turned)) +
           kEpsilon * static_cast<double>(pivot_.norm() + length_);
  }

 private:
  // In B.
  ExtendedMat3 inertia_about_joint(const Body& body) const {
    const ExtendedMat3 inertia = extended(body.inertia);
    const Extended axial = e_B_.dot(inertia * e_B_), across = (inertia.trace() - axial) / 2;
    const ExtendedMat3 along = e_B_ * e_B_.transpose();
    const ExtendedMat3 symmetric = across * (ExtendedMat3::Identity() - along) + axial * along;
    if ((inertia - symmetric).norm() > kRoundings * inertia.norm()) {
      refuse_precession(
          fmt::format("the inertia of body '{}' is not symmetric about the line to the joint", body.name));
    }
    return symmetric + body.mass * length_ * length_ * (ExtendedMat3::Identity() - along);
  }

  void split_spin(const ExtendedVec3& w, const ExtendedVec3& e, const ExtendedVec3& gravity) {
    const ExtendedVec3 across = e.cross(gravity);
    precession_ = ExtendedVec3::Zero();
    // w x e is W x e, and W is along gravity.
    if (across.norm() > kRoundings * gravity.norm()) {
      precession_ = -w.cross(e).dot(across) / across.squaredNorm() * gravity;
    }
    spin_ = (w - precession_).dot(e);
    if ((precession_ + spin_ * e - w).norm() > kRoundings * w.norm()) refuse_precession("its axis nods");
  }

  void check_steadiness(const Body& body, const ExtendedVec3& L, const ExtendedVec3& torque) {
    if (L.isZero(0) && torque.isZero(0)) return;
    const Extended missing = (precession_.cross(L) - torque).norm();
    if (missing > kRoundings * (precession_.norm() * L.norm() + torque.norm())) {
      refuse_precession(
          fmt::format("that of body '{}' is {:.17g} rad/s, at which the torque it takes is off by {:.3g} N m",
                      body.name, static_cast<double>(precession_.norm()), static_cast<double>(missing)));
    }
    misses_ = missing / L.norm() + std::numeric_limits<Extended>::epsilon() * precession_.norm();
  }

  ExtendedVec3 pivot_;  // m, in W
  ExtendedQuat start_;
  Extended length_ = 0;      // m, from the joint to the centre of mass
  ExtendedVec3 e_B_;         // unit, from the joint to the centre of mass, in B
  ExtendedVec3 precession_;  // rad/s, W, in W
  Extended spin_ = 0;        // rad/s, s
  Extended misses_ = 0;      // rad/s, at which L leaves its cone
};

// The one ball joint, between the top and the world.
ExtendedVec3 find_pivot(const Scene& scene) {
  if (scene.joints.size() != 1) refuse_precession(fmt::format("there are {} joints", scene.joints.size()));
  const Joint& joint = scene.joints[0];
  for (const int end : {joint.a, joint.b}) {
    if (end == kWorld || scene.bodies[end].fixed) return extended(std::get<BallJoint>(joint.type).anchor);
  }
  refuse_precession("the joint is between two bodies that move");
}

}  // namespace

TruthRow steady_precession_truth() {
  return {"steady-precession", "a heavy symmetric top on a ball joint, precessing steadily, in closed form",
          [](const Scene& scene, double) {
            check_needs(scene, "steady-precession", "a top on a ball joint", {joint_feature<BallJoint>()});
            const ExtendedVec3 pivot = find_pivot(scene);
            const auto moving =
                std::count_if(scene.bodies.begin(), scene.bodies.end(), [](const Body& body) { return !body.fixed; });
            if (moving != 1) refuse_precession(fmt::format("{} bodies move", moving));
            return closed_form(scene, [&](const Body& body) {
              return std::make_unique<SteadyPrecession>(body, pivot, scene.gravity);
            });
          }};
}

}  // namespace rigor::inline truth
