// Bodies fixed to each other and thrown. Together they are one rigid body, a free asymmetric top with the total mass,
// centre and inertia. Each body keeps its place in it,
//   p_i = P + Q (place_i),   q_i = Q turn_i,   v_i = V + w x (p_i - P)
// (the parallel-axis theorem: Goldstein, Classical Mechanics, 3rd ed., section 5.3; the top: asymmetric_top.cpp).
#include <fmt/format.h>

#include <algorithm>

#include "cases/truth/closed_form/smooth/asymmetric_top.h"
#include "core/base/error.h"

namespace rigor::inline truth {
namespace {

[[noreturn]] void refuse_welded(const std::string& why) {
  throw InputError("the truth 'welded' is for bodies in free flight, all fixed to each other: " + why);
}

// The one body that they are, with the orientation of W at t = 0.
Body united(const Scene& scene) {
  ExtendedVec3 centre = ExtendedVec3::Zero(), momentum = centre;
  Extended mass = 0;
  const auto for_moving = [&](const auto& visit) {
    for (const Body& body : scene.bodies) {
      if (!body.fixed) visit(body);
    }
  };
  for_moving([&](const Body& body) {
    mass += body.mass, centre += body.mass * extended(body.position), momentum += body.mass * extended(body.velocity);
  });
  centre /= mass;
  ExtendedMat3 inertia = ExtendedMat3::Zero();
  for_moving([&](const Body& body) {
    const ExtendedMat3 R = extended(body.orientation).toRotationMatrix();
    const ExtendedVec3 r = extended(body.position) - centre;
    inertia += R * extended(body.inertia) * R.transpose() +
               body.mass * (r.squaredNorm() * ExtendedMat3::Identity() - r * r.transpose());
  });
  Body whole;
  whole.name = "welded";
  whole.mass = static_cast<double>(mass), whole.inertia = ((inertia + inertia.transpose()) / 2).cast<double>();
  whole.position = centre.cast<double>(), whole.velocity = (momentum / mass).cast<double>();
  for_moving([&](const Body& body) { whole.angular_velocity = body.angular_velocity; });
  return whole;
}

void check(const Scene& scene, const Body& whole) {
  if (scene.joints.size() == 0) refuse_welded("there is no joint");
  std::vector<int> group(scene.bodies.size());
  for (std::size_t i = 0; i < group.size(); ++i) group[i] = static_cast<int>(i);
  for (const Joint& joint : scene.joints) {
    if (joint.a == kWorld || joint.b == kWorld || scene.bodies[joint.a].fixed || scene.bodies[joint.b].fixed)
      refuse_welded("a joint holds them to what stands still");
    std::replace(group.begin(), group.end(), int(group[joint.a]), int(group[joint.b]));
  }
  constexpr double kWeldedRoundings = 64 * kEpsilon;  // of the scene's numbers
  int first = -1;
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed) continue;
    if (first < 0) first = group[i];
    if (group[i] != first) refuse_welded(fmt::format("body '{}' is not fixed to the rest", body.name));
    const Vec3 w = whole.angular_velocity, v = whole.velocity + w.cross(body.position - whole.position);
    if ((body.angular_velocity - w).norm() > kWeldedRoundings * (1 + w.norm()) ||
        (body.velocity - v).norm() > kWeldedRoundings * (1 + v.norm()) * (1 + whole.position.norm()))
      refuse_welded(fmt::format("body '{}' does not move with the rest", body.name));
  }
}

class Part final : public BodyMotion {
 public:
  Part(const Body& body, const Body& whole, const Vec3& gravity)
      : whole_(asymmetric_top(whole, gravity)),
        place_(extended(body.position) - extended(whole.position)),
        turn_(extended(body.orientation)),
        spin_(whole.angular_velocity.norm()) {}

  ExtendedState at(Extended t) const override {
    const ExtendedState now = whole_->at(t);
    const ExtendedVec3 arm = now.orientation * place_;
    return {now.position + arm, now.orientation * turn_, now.velocity + now.angular_velocity.cross(arm),
            now.angular_velocity};
  }

  // The united body's numbers are rounded to double: moments by a share of a few roundings, by which its phases gain.
  double error(double t) const override {
    const double turned = spin_ * t, rounding = 4 * kEpsilon * (1 + turned);
    return (1 + static_cast<double>(place_.norm())) * (whole_->error(t) + rounding) + kEpsilon * (1 + t);
  }

 private:
  std::unique_ptr<BodyMotion> whole_;
  ExtendedVec3 place_;  // m, in the united body
  ExtendedQuat turn_;
  double spin_;  // rad/s
};

std::unique_ptr<Truth> make_welded(const Scene& scene, double) {
  check_needs(scene, "welded", "bodies fixed to each other", {joint_feature<FixedJoint>()});
  const Body whole = united(scene);
  check(scene, whole);
  return closed_form(scene, [&](const Body& body) { return std::make_unique<Part>(body, whole, scene.gravity); });
}

}  // namespace

TruthRow welded_truth() {
  return {"welded", "bodies fixed to each other in free flight, as one top in Jacobi's elliptic functions",
          make_welded};
}

}  // namespace rigor::inline truth
