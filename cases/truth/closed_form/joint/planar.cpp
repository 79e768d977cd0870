// A body on a planar joint, or on two sliders and a hinge in series that leave it the same motion. What holds it pushes
// along the normal n and turns it across n, so
//   p = p0 + v0 t + (g - n g.n) t²/2,   w n = w0 n
// (Goldstein, Classical Mechanics, 3rd ed., section 1.4).
#include <cmath>

#include "cases/truth/closed_form/joint/swinging_body.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

constexpr double kPlanarRoundings = 64 * kEpsilon;  // of the scene's numbers

[[noreturn]] void refuse_planar(const std::string& why) {
  throw InputError("the truth 'planar' is for one body that slides and turns in a plane: " + why);
}

class PlanarSlide final : public BodyMotion {
 public:
  PlanarSlide(const Body& body, const Vec3& gravity, const ExtendedVec3& normal)
      : path_(body, Vec3((extended(gravity) - normal.dot(extended(gravity)) * normal).cast<double>())),
        orientation_(extended(body.orientation)),
        spin_(normal.dot(extended(body.angular_velocity)) * normal) {}

  ExtendedState at(Extended t) const override {
    return {path_.position(t), turn(t * spin_) * orientation_, path_.velocity(t), spin_};
  }
  double error(double t) const override {
    // The gravity along the plane is rounded to double.
    return path_.error(t) + 8 * kExtendedEpsilon * static_cast<double>(spin_.norm()) * t;
  }

 private:
  Parabola path_;
  ExtendedQuat orientation_;
  ExtendedVec3 spin_;  // rad/s, in W
};

// Of a planar joint, or of two sliders and then a hinge that stand for one.
ExtendedVec3 normal_of(const Joint& joint) {
  if (const auto* planar = std::get_if<PlanarJoint>(&joint.type)) return extended(planar->normal).normalized();
  const auto* compound = std::get_if<CompoundJoint>(&joint.type);
  if (!compound || compound->axes.size() != 3) refuse_planar("the joint is no planar one");
  const auto& axes = compound->axes;
  if (axes[0].turns || axes[1].turns || !axes[2].turns) refuse_planar("its axes are not two sliders and then a hinge");
  for (int k = 0; k < 2; ++k) {
    if (std::abs(axes[static_cast<std::size_t>(k)].axis.dot(axes[2].axis)) > kPlanarRoundings)
      refuse_planar("a slider is not across the hinge's axis");
  }
  return extended(axes[2].axis).normalized();
}

std::unique_ptr<Truth> make_planar(const Scene& scene, double) {
  check_needs(scene, "planar", "one body that slides and turns in a plane",
              {joint_feature<PlanarJoint>(), joint_feature<CompoundJoint>()});
  const Joint* joint = nullptr;
  for (const Joint& row : scene.joints) {
    if (is_axis_of_compound(row)) continue;
    if (joint) refuse_planar("there are several joints");
    joint = &row;
  }
  if (!joint || stands(scene, joint->a) == stands(scene, joint->b))
    refuse_planar("the joint is not between it and what stands still");
  const ExtendedVec3 normal = normal_of(*joint);
  int moving = 0;
  for (const Body& body : scene.bodies) moving += body.fixed ? 0 : 1;
  if (moving != 1) refuse_planar("several bodies move");
  return closed_form(scene, [&](const Body& body) -> std::unique_ptr<BodyMotion> {
    const ExtendedVec3 v = extended(body.velocity), w = extended(body.angular_velocity);
    if (std::abs(normal.dot(v)) > kPlanarRoundings * (1 + v.norm()) ||
        normal.cross(w).norm() > kPlanarRoundings * (1 + w.norm()))
      refuse_planar("it leaves the plane");
    return std::make_unique<PlanarSlide>(body, scene.gravity, normal);
  });
}

}  // namespace

TruthRow planar_truth() { return {"planar", "a body that slides and turns in a plane, in closed form", make_planar}; }

}  // namespace rigor::inline truth
