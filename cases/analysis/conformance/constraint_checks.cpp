// Joints and contacts, each kind that the engine declares.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "cases/analysis/conformance/trial.h"

namespace rigor::inline analysis::conformance {
namespace {

constexpr double kStep = 1.0 / 240;  // s
// m and rad. Engines as shipped let joints open by some millimetres and bodies of a metre sink by up to 2 cm. A wrong
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
  const auto stays_in_the_plane = [=](Comparison& is, const BodyState& rod) {
    is.number("the anchor, along the normal, at", anchor_of(rod).y(), 0, kSlack);
    is.vector("the normal along", rod.orientation * y, y, kSlack);
  };
  const auto follows_the_thread = [=](Comparison& is, const BodyState& rod) {
    const Vec3 anchor = anchor_of(rod);
    is.vector("the anchor, across the axis, at", Vec3(anchor.x(), 0, anchor.z()), Vec3::Zero(), kSlack);
    const double turned = 2 * std::atan2(rod.orientation.y(), rod.orientation.w());
    is.number("along the axis, less whole turns, at",
              std::remainder(anchor.y() - 0.5 * turned / (2 * std::numbers::pi), 0.5), 0, kSlack);
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
  // Its second axis, which turns with the rod, stays across the first one.
  const auto turns_about_two_axes = [=](Comparison& is, const BodyState& rod) {
    keeps_anchor(is, rod);
    is.number("the cosine between both axes", y.dot(rod.orientation * z), 0, kSlack);
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
          {"planar", PlanarJoint{origin, y}, stays_in_the_plane},
          {"screw", ScrewJoint{origin, y, 0.5}, follows_the_thread},
          {"universal", UniversalJoint{origin, y, z}, turns_about_two_axes}};
}

CheckResult of_joint(const Trial& trial, const Joined& joined) {
  Body rod;
  rod.name = "rod", rod.position = {0.5, 0, 0}, rod.inertia = Vec3(0.01, 0.09, 0.09).asDiagonal();
  Scene scene = scene_of(rod, {1, 0.5, -9.81});
  scene.joints = {{.a = kWorld, .b = 0, .type = joined.joint}};
  // About each axis, so that the rod turns wherever the joint lets it. An engine may know no torques.
  scene.forces = {{.body = 0, .torque = {0.1, 0.1, 0.1}}};
  if (!why_not(trial, scene, kStep).empty()) scene.forces.clear();
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

// A rod that falls from the horizontal about a hinge at its end, which is the second body's, too, if there is one.
Scene falling_rod() {
  Body rod;
  rod.name = "rod", rod.position = {0.5, 0, 0}, rod.inertia = Vec3(0.01, 0.09, 0.09).asDiagonal();
  Scene scene = scene_of(rod, {0, 0, -9.81});
  scene.joints = {{.a = kWorld, .b = 0, .type = HingeJoint{Vec3::Zero(), Vec3::UnitY()}, .name = "pivot"}};
  return scene;
}

// x'' = 9.81 / 2 / (0.25 + 0.09 + 1) cos x; without the rotor the rod would fall four times as fast.
CheckResult a_rotor_is_carried(const Trial& trial) {
  Scene scene = falling_rod();
  scene.joints[0].armature = 1;
  if (const std::string why = why_not(trial, scene, kStep); !why.empty()) return not_asked(why);
  TriedWorld world(trial, scene);
  const BodyState came = world.step(kStep, 60).state().columns().body(0);
  Comparison is(world.sent() + "; read");
  constexpr double kAngle = 0.11434;  // rad after a quarter of a second
  is.vector("position", came.position, {0.5 * std::cos(kAngle), 0, -0.5 * std::sin(kAngle)}, kSlack);
  return is.result();
}

// The second rod turns by -0.5 of the first one's angle.
CheckResult a_coupling_holds(const Trial& trial) {
  Scene scene = falling_rod();
  Body other = scene.bodies[0];
  other.name = "other", other.position = {0.5, 2, 0};
  scene.bodies.push_back(other);
  scene.joints.push_back({.a = kWorld, .b = 1, .type = HingeJoint{{0, 2, 0}, Vec3::UnitY()}, .name = "geared"});
  scene.couplings = {{.joint = 1, .to = {{.joint = 0, .ratio = -0.5}}}};
  if (const std::string why = why_not(trial, scene, kStep); !why.empty()) return not_asked(why);
  TriedWorld world(trial, scene);
  const BodyTable came = world.step(kStep, 96).state();
  const auto angle = [&](std::size_t i) {
    const Quat q = came.columns().orientation(i);
    return 2 * std::atan2(q.y(), q.w());
  };
  Comparison is(world.sent() + "; read");
  is.number("the coupled angle less -0.5 of the other", angle(1) + 0.5 * angle(0), 0, kSlack);
  if (std::abs(angle(0)) < 0.1) return broken(world.sent() + "; read", "rods that stand still", "rods that fall");
  return is.result();
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
  const Mesh slab{{closed_surface(scaled(unit_cube(), Vec3(4, 4, 1)))}};
  Heightfield field;
  field.size = {4, 4}, field.heights.assign(5, std::vector<double>(5, 0.0));
  field.surface = height_surface(field.size, field.heights);
  return {{sphere, plane, 0.5},  {box, plane, 0.5},    {capsule, plane, 1}, {box, box, 1},
          {sphere, box, 1},      {capsule, box, 1.5},  {sphere, sphere, 1}, {capsule, sphere, 1.5},
          {capsule, capsule, 2}, {sphere, field, 0.5}, {box, field, 0.5},   {capsule, field, 1},
          {sphere, slab, 1},     {box, slab, 1},       {capsule, slab, 1.5}};
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
          {"armature", "a rotor on a joint's axis is moved, too", a_rotor_is_carried},
          {"coupling", "coupled joints turn in their ratio", a_coupling_holds},
          {"contacts", "each pair of shapes that is declared rests at the right height", bodies_rest_on_each_other}};
}

}  // namespace rigor::inline analysis::conformance
