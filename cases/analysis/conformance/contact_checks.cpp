// Reports of contact forces, by Newton's law and by the geometry of one box on the ground.
#include <fmt/format.h>

#include <algorithm>

#include "cases/analysis/conformance/trial.h"

namespace rigor::inline analysis::conformance {
namespace {

constexpr double kContactStep = 1.0 / 240;  // s
constexpr double kG = 9.81, kPush = 2;      // m/s², N: a push that friction holds
// As shipped, bodies of a metre sink by up to 2 cm, and points of an overlap lie anywhere within it. m, and of a unit
constexpr double kPlace = 0.03, kAskew = 0.03;
// Of the weight: solvers end their iterations at 1e-6, and a sign, a frame or a share is wrong by tenths.
constexpr double kExplained = 1e-3;
constexpr double kOffset = 0.01,
                 kNoOffset = 0.002;  // m, of a box that begins beside its place, and of one that is there

Scene box_on_ground(double height) {
  Scene scene;
  scene.gravity = {0, 0, -kG};
  scene.bodies = {solid("ground", Plane{{0, 0, 1}, 0}, Vec3::Zero()), solid("box", Box{{1, 1, 1}}, {0, 0, height})};
  scene.forces = {{.body = 1, .force = Vec3(kPush, 0, 0)}};
  scene.contact_default = {0, 0.5};
  return scene;
}

Vec3 force_on_box(const std::vector<ReportedContact>& contacts) {
  Vec3 sum = Vec3::Zero();
  for (const ReportedContact& contact : contacts) sum += contact.b == 1 ? contact.force : Vec3(-contact.force);
  return sum;
}

// The pair, the normal and the place of each point.
CheckResult points_lie_between(const std::string& sent, const std::vector<ReportedContact>& contacts) {
  Comparison is(sent);
  for (const ReportedContact& contact : contacts) {
    if (std::minmax(contact.a, contact.b) != std::minmax(0, 1))
      return broken(sent, fmt::format("a contact of bodies {} and {}", contact.a, contact.b), "of bodies 0 and 1");
    is.vector("the normal from a to b", contact.normal, contact.b == 1 ? Vec3::UnitZ() : Vec3(-Vec3::UnitZ()), kAskew);
    is.number("the point's height [m]", contact.point.z(), 0, kPlace);
    const double off = std::max(std::abs(contact.point.x()), std::abs(contact.point.y()));
    is.number("the point's distance beyond the box's face [m]", std::max(0.0, off - 0.5), 0, kPlace);
  }
  return is.result();
}

// Of an overlap the least gap is negative, and of a box above the ground no gap is.
CheckResult gaps_have_their_sign(const Trial& trial, double offset) {
  TriedWorld world(trial, box_on_ground(0.5 + offset));
  world.asks_for_contacts();
  world.step(kContactStep);
  const std::vector<ReportedContact> contacts = world.contacts();
  double least = 0, largest = 0;
  for (const ReportedContact& contact : contacts)
    least = std::min(least, contact.gap), largest = std::max(largest, contact.gap);
  if (offset < 0 && largest > kNoOffset)
    return broken(world.sent(), fmt::format("a gap of {:.3g} m", largest), "a negative gap: the box overlaps");
  if (offset > 0 && least < -kNoOffset)
    return broken(world.sent(), fmt::format("a gap of {:.3g} m", least), "a positive gap: the box is above the ground");
  return holds();
}

CheckResult contact_forces_move_the_bodies(const Trial& trial) {
  const Scene scene = box_on_ground(0.5);
  if (const std::string why = why_not(trial, scene, kContactStep); !why.empty()) return not_asked(why);
  TriedWorld world(trial, scene);
  if (!world.asks_for_contacts()) return not_asked("it reports no contact forces");
  const BodyState before = world.step(kContactStep, 240).state().columns().body(1);
  const BodyState after = world.step(kContactStep).state().columns().body(1);
  const std::vector<ReportedContact> contacts = world.contacts();
  const double mass = scene.bodies[1].mass;
  const Vec3 due = mass * ((after.velocity - before.velocity) / kContactStep - scene.gravity) - Vec3(kPush, 0, 0);
  Comparison is(world.sent());
  is.vector("the sum of the forces on the box", force_on_box(contacts), due, kExplained * mass * kG);
  if (is.result().answer == CheckResult::Answer::broken) return is.result();
  const CheckResult placed = points_lie_between(world.sent(), contacts);
  if (placed.answer == CheckResult::Answer::broken) return placed;
  const CheckResult sunk = gaps_have_their_sign(trial, -kOffset);
  return sunk.answer == CheckResult::Answer::broken ? sunk : gaps_have_their_sign(trial, kOffset);
}

}  // namespace

std::vector<ConformanceCheck> contact_checks() {
  return {{"contact-forces",
           "reported contact forces, with the loads, explain how a body moves, and lie where it touches",
           contact_forces_move_the_bodies}};
}

}  // namespace rigor::inline analysis::conformance
