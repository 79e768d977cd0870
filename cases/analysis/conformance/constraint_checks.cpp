// Joints and contacts, each kind that the engine declares.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "cases/analysis/conformance/trial.h"

namespace rigor::conformance {
namespace {

constexpr double kStep = 1.0 / 240;  // s
// m and rad. As shipped, engines let joints open by some millimetres and bodies of a metre sink by up to 2 cm. A wrong
// anchor, axis or size makes an error of tenths.
constexpr double kSlack = 0.03;

// A rod half a metre from the origin, to which it is joined.
struct Joined {
  std::string type;
  decltype(Joint::type) joint;
  std::function<void(Comparison&, const BodyState&)> keeps;
};

Vec3 anchor_of(const BodyState& rod) { return rod.position + rod.orientation * Vec3(-0.5, 0, 0); }

std::vector<Joined> joined_rods() {
  const Vec3 origin = Vec3::Zero(), y = Vec3::UnitY(), z = Vec3::UnitZ();
  const auto keeps_anchor = [](Comparison& is, const BodyState& rod) {
    is.vector("the anchor at", anchor_of(rod), Vec3::Zero(), kSlack);
  };
  const auto swings_about_y = [=](Comparison& is, const BodyState& rod) {
    keeps_anchor(is, rod);
    is.vector("the hinge's axis along", rod.orientation * y, y, kSlack);
  };
  const auto turns_and_slides_along_y = [=](Comparison& is, const BodyState& rod) {
    const Vec3 anchor = anchor_of(rod);
    is.vector("the anchor, across the axis, at", Vec3(anchor.x(), 0, anchor.z()), Vec3::Zero(), kSlack);
    is.vector("the axis along", rod.orientation * y, y, kSlack);
    is.number("along the axis at", anchor.y(), 0.5 * 0.5 * 0.25, kSlack);
  };
  const auto slides = [](Comparison& is, const BodyState& rod) {
    is.vector("across the axis at", Vec3(rod.position.x(), rod.position.y(), 0), {0.5, 0, 0}, kSlack);
    is.orientation(rod.orientation, Quat::Identity(), kSlack);
    is.number("along the axis at", rod.position.z(), -0.5 * 9.81 * 0.25, kSlack);
  };
  const auto stays = [](Comparison& is, const BodyState& rod) {
    is.vector("position", rod.position, {0.5, 0, 0}, kSlack);
    is.orientation(rod.orientation, Quat::Identity(), kSlack);
  };
  const auto keeps_distance = [](Comparison& is, const BodyState& rod) {
    is.number("distance", rod.position.norm(), 0.5, kSlack);
  };
  return {{"ball", BallJoint{origin}, keeps_anchor},
          {"cylindrical", CylindricalJoint{origin, y}, turns_and_slides_along_y},
          {"hinge", HingeJoint{origin, y}, swings_about_y},
          {"slider", SliderJoint{z}, slides},
          {"fixed", FixedJoint{}, stays},
          {"distance", DistanceJoint{origin, origin}, keeps_distance},
          {"universal", UniversalJoint{origin, y, z}, keeps_anchor}};
}

CheckResult of_joint(const Trial& trial, const Joined& joined) {
  Body rod;
  rod.name = "rod", rod.position = {0.5, 0, 0}, rod.inertia = Vec3(0.01, 0.09, 0.09).asDiagonal();
  Scene scene = scene_of(rod, {1, 0.5, -9.81});
  scene.joints = {{.a = kWorld, .b = 0, .type = joined.joint}};
  if (const std::string why = why_not(trial, scene, kStep); !why.empty()) return not_asked(why);
  TriedWorld world(trial, scene);
  const BodyState came = world.step(kStep, 120).state().columns().body(0);
  Comparison is(world.sent() + "; read");
  joined.keeps(is, came);
  // A body that moves at all has moved after half a second.
  if (joined.type != "fixed" && (came.position - rod.position).norm() < 0.1)
    return broken(world.sent() + "; read", "a body that stands still", "one that swings or slides down");
  return is.result();
}

CheckResult joints_hold(const Trial& trial) {
  int asked = 0;
  for (const Joined& joined : joined_rods()) {
    const CheckResult result = of_joint(trial, joined);
    if (result.answer == CheckResult::Answer::broken) return result;
    asked += result.answer == CheckResult::Answer::holds;
  }
  return asked > 0 ? holds() : not_asked("it declares no joint");
}

struct Resting {
  Shape above, below;
  double height;  // m, of the upper one's centre when it rests, the lower one's centre (or plane) being at 0
};

std::vector<Resting> resting_pairs() {
  const Sphere sphere{0.5};
  const Box box{{1, 1, 1}};
  const Capsule capsule{0.5, 1};  // upright: half its length and its radius are 1
  const Plane plane{{0, 0, 1}, 0};
  return {{sphere, plane, 0.5}, {box, plane, 0.5},   {capsule, plane, 1},    {box, box, 1},        {sphere, box, 1},
          {capsule, box, 1.5},  {sphere, sphere, 1}, {capsule, sphere, 1.5}, {capsule, capsule, 2}};
}

// The scene with a friction that the engine has, if there is one.
std::string take_friction(const Trial& trial, Scene& scene) {
  std::string why;
  for (const double friction : {0.5, kInfiniteFriction, 0.0}) {
    scene.contact_default = {0, friction};
    why = why_not(trial, scene, kStep);
    if (why.empty()) return "";
  }
  return why;
}

CheckResult of_contact(const Trial& trial, const Resting& pair) {
  const double drop = 0.05;
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {solid("above", pair.above, {0, 0, pair.height + drop}), solid("below", pair.below, Vec3::Zero())};
  scene.bodies[1].fixed = true;
  if (const std::string why = take_friction(trial, scene); !why.empty()) return not_asked(why);
  TriedWorld world(trial, scene);
  const BodyState came = world.step(kStep, 240).state().columns().body(0);
  Comparison is(world.sent() + "; read");
  is.number("the height of 'above' [m]", came.position.z(), pair.height, kSlack);
  return is.result();
}

CheckResult bodies_rest_on_each_other(const Trial& trial) {
  int asked = 0;
  std::string why = "it declares no contact";
  for (const Resting& pair : resting_pairs()) {
    if (!trial.info.features.contains(contact_feature(pair.above, pair.below))) continue;
    const CheckResult result = of_contact(trial, pair);
    if (result.answer == CheckResult::Answer::broken) return result;
    if (result.answer == CheckResult::Answer::not_asked) why = result.why;
    asked += result.answer == CheckResult::Answer::holds;
  }
  return asked > 0 ? holds() : not_asked(why);
}

}  // namespace

std::vector<ConformanceCheck> constraint_checks() {
  return {{"joints", "each joint that is declared holds what it joins, and lets the rest move", joints_hold},
          {"contacts", "each pair of shapes that is declared rests at the right height", bodies_rest_on_each_other}};
}

}  // namespace rigor::conformance
