// Cylinders and ellipsoids on boxes, hulls, each other and triangles. The second derivations are a plane at the same
// height, closed forms, and turned worlds.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "cases/metrics/measures/shape_gap.h"
#include "core/scene/turned.h"
#include "tests/core/dynamics/contact/contact_runs.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_impulse_curved_bodies)

namespace {

constexpr double kG = 9.81, kStep = 1.0 / 240;

Quat lying() { return rotation_by({0.5 * std::numbers::pi, 0, 0}); }  // a cylinder along y

Body fixed_body(const Shape& shape, const Vec3& position, const Quat& orientation = Quat::Identity()) {
  Body body = solid("ground", shape, position);
  body.fixed = true, body.orientation = orientation;
  return body;
}

// The ground at z = 0, as each shape that has a level face.
std::vector<Body> level_grounds() {
  std::vector<Vec3> corners;
  for (int k = 0; k < 8; ++k) corners.emplace_back(k & 1 ? 10 : -10, k & 2 ? 10 : -10, k & 4 ? 0.5 : -0.5);
  Heightfield field;
  field.size = {20, 20}, field.heights.assign(41, std::vector<double>(41, 0.0));
  field.surface = height_surface(field.size, field.heights);
  const Mesh slab{{closed_surface(scaled(unit_cube(), Vec3(20, 20, 1)))}};
  return {fixed_body(Box{{20, 20, 1}}, {0, 0, -0.5}), fixed_body(Convex{hull_of(corners)}, {0, 0, -0.5}),
          fixed_body(Cylinder{10, 1}, {0, 0, -0.5}), fixed_body(field, Vec3::Zero()), fixed_body(slab, {0, 0, -0.5})};
}

Scene on_ground(const Body& moving, const Body& ground, double friction) {
  Scene scene;
  scene.gravity = {0, 0, -kG};
  scene.bodies = {moving, ground};
  scene.contact_default = {0, friction};
  return scene;
}

// Bodies that stand, lie, slide, roll, spin, and fall on a rim.
std::vector<Body> motions() {
  Body stands = solid("stands", Cylinder{0.3, 0.8}, {0.1, 0.2, 0.4}), slides = stands, rolls = stands, falls = stands,
       coin = solid("coin", Cylinder{0.3, 0.04}, {0.1, 0.2, 0.3}),
       egg = solid("egg", Ellipsoid{{0.2, 0.3, 0.25}}, {0, 0, 0.25}), tumbles = egg;
  slides.velocity = {1.5, 0.3, 0};
  rolls.position.z() = 0.3, rolls.orientation = lying(), rolls.velocity = {1.2, 0, 0},
  rolls.angular_velocity = {0, 4, 0};
  falls.position.z() = 0.7, falls.orientation = rotation_by({0.3, 0.2, 0.1}), falls.angular_velocity = {1, 0.5, 2};
  coin.orientation = lying(), coin.velocity = {0.8, 0, 0}, coin.angular_velocity = {0.2, 2.5, 0.6};
  egg.velocity = {0.5, 0.2, 0};
  tumbles.position.z() = 0.5, tumbles.orientation = rotation_by({0.4, 0.3, 0.2}),
  tumbles.angular_velocity = {1, -2, 0.7};
  return {stands, slides, rolls, falls, coin, egg, tumbles};
}

}  // namespace

// A large level face is a plane. The first 0.3 s are compared where the motion grows an error.
BOOST_AUTO_TEST_CASE(on_a_level_face_they_move_as_on_a_plane) {
  const Body plane = floor_at();
  for (const Body& body : motions()) {
    for (const Body& ground : level_grounds()) {
      ContactRun on_plane(on_ground(body, plane, 0.4), "impulse", "semi-implicit-euler"),
          on_face(on_ground(body, ground, 0.4), "impulse", "semi-implicit-euler");
      double worst = 0;
      for (int n = 0; n < 72; ++n) {
        on_plane.step(kStep), on_face.step(kStep);
        worst = std::max(worst, (on_plane.state().position(0) - on_face.state().position(0)).norm());
        worst = std::max(worst, 0.3 * on_plane.state().orientation(0).angularDistance(on_face.state().orientation(0)));
      }
      BOOST_TEST_MESSAGE(body.name << " on " << shape_name(*ground.shape) << ": " << worst);
      BOOST_TEST(worst < 1e-9, body.name << " on " << shape_name(*ground.shape) << ": " << worst);
    }
  }
}

// Down a face of a box, tilted by 0.5 rad. Newton: a = 2/3 g sin(angle) without slip; the axis stays level.
BOOST_AUTO_TEST_CASE(a_cylinder_rolls_straight_down_a_tilted_face) {
  constexpr double kAngle = 0.5, kRadius = 0.2, kTime = 1;
  const Quat tilt = rotation_by({0, kAngle, 0});
  Body roller = solid("roller", Cylinder{kRadius, 0.5}, tilt * Vec3(-3, 0.3, 0.5 + kRadius));
  roller.orientation = tilt * lying();
  ContactRun run(on_ground(roller, fixed_body(Box{{10, 10, 1}}, Vec3::Zero(), tilt), 0.6), "impulse",
                 "semi-implicit-euler");
  run.run(kStep, static_cast<int>(kTime / kStep + 0.5));
  const Vec3 moved = tilt.conjugate() * (run.state().position(0) - roller.position);
  const double way = 0.5 * 2.0 / 3 * kG * std::sin(kAngle) * kTime * kTime;
  BOOST_TEST_MESSAGE("way " << moved.x() << " of " << way << ", aside " << moved.y() << ", up " << moved.z());
  BOOST_TEST(std::abs(moved.x() - way) < 2e-3 * way);  // a sub-step of 1/960 s of first order, or 1e-3 of a second
  BOOST_TEST(std::abs(moved.y()) < 1e-9);
  BOOST_TEST(std::abs(moved.z()) < 1e-5);
}

BOOST_AUTO_TEST_CASE(ten_cylinders_stand_on_each_other) {
  std::vector<Body> stack;
  for (int i = 0; i < 10; ++i) {
    stack.push_back(solid("drum " + std::to_string(i), Cylinder{0.5, 1}, {0.02 * (i % 3), 0.01 * (i % 2), 0.5 + i}));
    stack.back().orientation = rotation_by({0, 0, 0.7 * i});
  }
  const Scene scene = on_floor(stack, {0, 0.5});
  ContactRun run(scene, "impulse", "semi-implicit-euler");
  run.run(1.0 / 60, 600);
  double most = 0;
  for (std::size_t i = 0; i < 10; ++i) most = std::max(most, (run.state().position(i) - stack[i].position).norm());
  BOOST_TEST_MESSAGE("moved " << most << ", speed " << run.state().velocity(9).norm());
  BOOST_TEST(most < 1e-3);                            // the goal of the method, as for boxes
  BOOST_TEST(run.state().velocity(9).norm() < 1e-6);  // 1.3e-7 m/s measured, and falling
  BOOST_TEST(run.solver_warning() == "");
}

// The contact area ends at the box's edge. So a drum whose centre is over the box stands, and another one falls.
BOOST_AUTO_TEST_CASE(a_drum_stands_on_an_edge_until_its_centre_is_beyond) {
  for (const Shape& below : {Shape(Box{{2, 2, 1}}), Shape(Cylinder{1, 1})}) {
    for (const double beyond : {-0.02, 0.02}) {
      const Body drum = solid("drum", Cylinder{0.4, 0.6}, {1 + beyond, 0, 0.8});
      ContactRun run(on_ground(drum, fixed_body(below, Vec3::Zero()), 0.8), "impulse", "semi-implicit-euler");
      run.run(kStep, 240);
      const double fallen = drum.position.z() - run.state().position(0).z();
      BOOST_TEST_MESSAGE(shape_name(below) << " " << beyond << " " << fallen);
      if (beyond < 0)
        BOOST_TEST(std::abs(fallen) < 1e-6);
      else
        BOOST_TEST(fallen > 0.01);
    }
  }
}

// A box across a lying cylinder is stable if half its height is less than the radius. A line of contact holds it.
BOOST_AUTO_TEST_CASE(a_box_balances_on_a_lying_cylinder) {
  const Body plank = solid("plank", Box{{1.5, 0.6, 0.2}}, {0, 0, 0.6});
  Body log = fixed_body(Cylinder{0.5, 1}, Vec3::Zero());
  log.orientation = lying();
  ContactRun run(on_ground(plank, log, 0.8), "impulse", "semi-implicit-euler");
  run.run(kStep, 480);
  BOOST_TEST((run.state().position(0) - plank.position).norm() < 1e-6);
  BOOST_TEST(run.state().angular_velocity(0).norm() < 1e-9);
}

// A log in the groove of two others, whose axes are as far apart as their radii: each carries W / (2 cos 30°), along a
// line of two points.
BOOST_AUTO_TEST_CASE(a_log_in_a_groove_is_carried_by_both_sides) {
  constexpr double kRadius = 0.2;
  Scene scene;
  scene.gravity = {0, 0, -kG};
  scene.bodies = {solid("upper", Cylinder{kRadius, 1}, {0, 0.1, std::sqrt(3.0) * kRadius}, 2),
                  fixed_body(Cylinder{kRadius, 1.5}, {-kRadius, 0, 0}),
                  fixed_body(Cylinder{kRadius, 1.5}, {kRadius, 0, 0})};
  for (Body& body : scene.bodies) body.orientation = lying();
  scene.contact_default = {0, 0};
  ContactRun run(scene, "impulse", "semi-implicit-euler");
  run.contact_reports().ask_for_contacts();
  run.run(kStep, 240);
  std::array<Vec3, 3> force = {Vec3::Zero(), Vec3::Zero(), Vec3::Zero()};
  int points = 0;
  for (const ReportedContact& contact : run.contact_reports().contacts()) {
    const int side = std::max(contact.a, contact.b);
    force[static_cast<std::size_t>(side)] += contact.a == 0 ? Vec3(-contact.force) : contact.force;
    ++points;
  }
  const double each = 2 * kG / (2 * std::cos(std::numbers::pi / 6));
  BOOST_TEST(points == 4);
  for (const std::size_t side : {1u, 2u}) {
    const Vec3 n(side == 1 ? 0.5 : -0.5, 0, std::sqrt(0.75));
    BOOST_TEST((force[side] - each * n).norm() < 1e-4 * each);
  }
  BOOST_TEST((run.state().position(0) - scene.bodies[0].position).norm() < 1e-5);
}

// An elastic impact without friction: momentum and energy stay, and the impulse acts along the normal of both surfaces.
BOOST_AUTO_TEST_CASE(ellipsoids_bounce_off_each_other) {
  Scene scene;
  scene.bodies = {solid("a", Ellipsoid{{0.2, 0.3, 0.5}}, {0, 0, 0}),
                  solid("b", Ellipsoid{{0.4, 0.25, 0.3}}, {1.2, 0.1, 0.2})};
  scene.bodies[0].velocity = {1, 0.2, 0.1}, scene.bodies[0].angular_velocity = {0.3, -0.5, 1};
  scene.bodies[1].velocity = {-1, 0, 0}, scene.bodies[1].orientation = rotation_by({0.5, 0.2, 0.9});
  scene.contact_default = {1, 0};
  ContactRun run(scene, "impulse", "rkmk4");
  const auto energy = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < 2; ++i) {
      const Mat3 R = run.state().rotation(i);
      const Vec3 v = run.state().velocity(i), w = R.transpose() * run.state().angular_velocity(i);
      sum += 0.5 * v.squaredNorm() + 0.5 * w.dot(scene.bodies[i].inertia * w);
    }
    return sum;
  };
  const double before = energy();
  run.run(kStep, 240);
  BOOST_TEST((run.state().velocity(0) - scene.bodies[0].velocity).norm() > 0.5);  // they have met
  BOOST_TEST((run.state().velocity(0) + run.state().velocity(1) - Vec3(0, 0.2, 0.1)).norm() < 1e-12);
  BOOST_TEST(std::abs(energy() - before) < 1e-6 * before);
}

// In a turned and moved world everything is turned and moved.
BOOST_AUTO_TEST_CASE(a_turned_pile_moves_as_it_did) {
  Scene scene;
  scene.gravity = {0, 0, -kG};
  scene.bodies = {solid("drum", Cylinder{0.3, 0.5}, {0.1, 0, 0.25}),
                  solid("egg", Ellipsoid{{0.3, 0.2, 0.15}}, {0.15, 0.1, 0.66}),
                  solid("rod", Capsule{0.1, 0.6}, {0.8, 0, 0.1}),
                  solid("coin", Cylinder{0.4, 0.06}, {0.75, 0.05, 0.25}), fixed_body(Box{{6, 6, 1}}, {0, 0, -0.5})};
  scene.bodies[2].orientation = lying();
  scene.contact_default = {0, 0.5};
  const Quat turn = rotation_by({0.4, -1.1, 0.7});
  ContactRun here(scene, "impulse", "semi-implicit-euler"),
      there(turned(scene, turn), "impulse", "semi-implicit-euler");
  here.run(kStep, 60), there.run(kStep, 60);
  for (std::size_t i = 0; i < 4; ++i) {
    const double apart = (turn * here.state().position(i) - there.state().position(i)).norm();
    BOOST_TEST(apart < 1e-9, scene.bodies[i].name << " " << apart);
  }
}

BOOST_AUTO_TEST_SUITE_END()
