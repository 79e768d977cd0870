// Surfaces of triangles in contact by events: where they are flat they are planes, and a mesh of a box is that box.
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

#include "core/dynamics/contact/event/clearance/ground_gap.h"
#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/contact/event/event_ends.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_surface_contact)

namespace {

using Law = std::pair<double, double>;  // restitution and friction
constexpr double kSlope = 0.5;

Body ground(const Shape& shape, const Vec3& position = Vec3::Zero(), const Quat& orientation = Quat::Identity()) {
  Body body;
  body.name = "ground", body.shape = shape;
  body.fixed = body.collides = true;
  body.position = position, body.orientation = orientation;
  return body;
}

Heightfield field(std::array<double, 2> size, std::array<std::size_t, 2> counts,
                  const std::function<double(double x, double y)>& height) {
  Heightfield made;
  made.size = size, made.heights.assign(counts[1], std::vector<double>(counts[0]));
  for (std::size_t i = 0; i < counts[1]; ++i)
    for (std::size_t k = 0; k < counts[0]; ++k)
      made.heights[i][k] = height(size[0] * (static_cast<double>(k) / static_cast<double>(counts[0] - 1) - 0.5),
                                  size[1] * (static_cast<double>(i) / static_cast<double>(counts[1] - 1) - 0.5));
  made.surface = height_surface(made.size, made.heights);
  return made;
}

Mesh mesh_of_box(const Vec3& size) { return {{closed_surface(scaled(unit_cube(), size))}}; }

std::vector<Shape> shapes() {
  return {Sphere{0.15}, Box{{0.3, 0.4, 0.2}}, Capsule{0.1, 0.3},
          Convex{hull_of({{0.2, 0, -0.1}, {-0.2, 0.1, -0.1}, {0, -0.2, 0.15}, {0, 0.2, 0.2}, {0.1, 0.1, 0.3}})}};
}

Body thrown(const Shape& shape, const Vec3& position, const Vec3& velocity) {
  Body body = solid("thrown", shape, position);
  body.velocity = velocity, body.angular_velocity = {1, 2, 0.5};
  body.orientation = rotation_by({0.2, 0.3, 0.1});
  return body;
}

BodyTable end_of(const Body& body, const std::vector<Body>& grounds, const Law& law, const char* integrator, double dt,
                 int steps) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {body};
  scene.bodies.insert(scene.bodies.end(), grounds.begin(), grounds.end());
  scene.contact_default = {law.first, law.second};
  return event_end(scene, integrator, dt, steps);
}

std::string named(const Shape& shape, const Law& law) {
  return shape_name(shape) + ", e = " + std::to_string(law.first) + ", mu = " + std::to_string(law.second);
}

}  // namespace

// Over seams of a height field and of a slab. A box that rattles to rest is left out: its events crowd on a plane, too.
BOOST_AUTO_TEST_CASE(bodies_move_on_flat_triangles_as_on_a_plane) {
  const Body plane = ground(Plane{Vec3::UnitZ(), 0}),
             flat = ground(field({6, 4}, {25, 17}, [](double, double) { return 0.0; })),
             slab = ground(mesh_of_box({6, 4, 0.4}), {0, 0, -0.2});
  for (const Shape& shape : shapes()) {
    for (const Law& law : {Law{0, 0}, {0, 0.4}, {0.3, 1}}) {
      const Body body = thrown(shape, {0.03, 0.02, 0.5}, {1, 0.4, 0});
      BOOST_TEST_CONTEXT(named(shape, law)) {
        const BodyTable due = end_of(body, {plane}, law, "dormand-prince", 1.0 / 60, 60);
        BOOST_TEST(first_body_apart(due, end_of(body, {flat}, law, "dormand-prince", 1.0 / 60, 60)) < 1e-11);
        BOOST_TEST(first_body_apart(due, end_of(body, {slab}, law, "dormand-prince", 1.0 / 60, 60)) < 1e-11);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(bodies_move_on_a_ramp_of_triangles_as_on_a_tilted_plane) {
  const Quat tilt = rotation_by({0, std::atan(kSlope), 0});
  const Body plane = ground(Plane{tilt * Vec3::UnitZ(), 0}),
             hill = ground(field({8, 4}, {33, 17}, [](double x, double) { return -kSlope * x; })),
             slab = ground(mesh_of_box({8, 4, 0.4}), tilt * Vec3(0, 0, -0.2), tilt);
  for (const Shape& shape : shapes()) {
    for (const Law& law : {Law{0, 0.3}, {0.5, 0.3}}) {
      const Body body = thrown(shape, {-1.2, 0.02, 1.2}, {0.2, 0.4, 0});
      BOOST_TEST_CONTEXT(named(shape, law)) {
        const BodyTable due = end_of(body, {plane}, law, "dormand-prince", 1.0 / 60, 48);
        BOOST_TEST(first_body_apart(due, end_of(body, {hill}, law, "dormand-prince", 1.0 / 60, 48)) < 1e-10);
        BOOST_TEST(first_body_apart(due, end_of(body, {slab}, law, "dormand-prince", 1.0 / 60, 48)) < 1e-10);
      }
    }
  }
}

BOOST_AUTO_TEST_CASE(bodies_move_in_a_groove_of_triangles_as_between_two_planes) {
  constexpr double kSide = 0.7;
  const std::vector<Body> planes = {ground(Plane{Vec3(kSide, 0, 1).normalized(), 0}),
                                    ground(Plane{Vec3(-kSide, 0, 1).normalized(), 0})},
                          groove = {
                              ground(field({4, 4}, {17, 5}, [](double x, double) { return kSide * std::abs(x); }))};
  for (const Shape& shape : shapes()) {
    for (const Law& law : {Law{0, 0}, {0, 0.3}}) {
      const Body body = thrown(shape, {-0.2, 0.02, 0.6}, {0.2, 0.4, 0});
      BOOST_TEST_CONTEXT(named(shape, law)) {
        BOOST_TEST(first_body_apart(end_of(body, planes, law, "dormand-prince", 1.0 / 60, 60),
                                    end_of(body, groove, law, "dormand-prince", 1.0 / 60, 60)) < 1e-9);
      }
    }
  }
}

// Off the edge and past a corner.
BOOST_AUTO_TEST_CASE(round_bodies_roll_off_a_mesh_of_a_box_as_off_the_box) {
  const Vec3 size(1, 1, 0.4);
  Body box = solid("box", Box{size}, Vec3::Zero());
  box.fixed = true;
  for (const Shape& shape : {Shape(Sphere{0.15}), Shape(Capsule{0.1, 0.3})}) {
    for (const Law& law : {Law{0, 0}, {0, 0.3}, {0.5, 0.3}}) {
      for (const Vec3& velocity : {Vec3(1.5, 0.4, 0), Vec3(1, 1.05, 0)}) {
        const Body body = thrown(shape, {0.1, 0.02, 0.6}, velocity);
        BOOST_TEST_CONTEXT(named(shape, law) << ", at " << velocity.y()) {
          BOOST_TEST(first_body_apart(end_of(body, {box}, law, "dormand-prince", 1.0 / 60, 60),
                                      end_of(body, {ground(mesh_of_box(size))}, law, "dormand-prince", 1.0 / 60, 60)) <
                     1e-10);
        }
      }
    }
  }
}

// A wall of 2 cm across the way of a ball that makes 17 cm in a step, once rolling on the ground and once in flight.
BOOST_AUTO_TEST_CASE(a_thin_ridge_is_met_within_a_long_step) {
  const Body wall = ground(field({4, 4}, {201, 3}, [](double x, double) { return std::abs(x) < 0.005 ? 0.4 : 0.0; }));
  for (const double height : {0.1, 0.25}) {
    Body ball = solid("ball", Sphere{0.1}, {-1.013, 0.3, height});
    ball.velocity = {5, 0, height > 0.1 ? 1.0 : 0.0};
    const BodyTable end = end_of(ball, {wall}, {0.5, 0}, "dormand-prince", 1.0 / 30, 10);
    BOOST_TEST(end.columns().position(0).x() < -0.1);
    BOOST_TEST(end.columns().velocity(0).x() < 0);
  }
}

// Each step ends outside of the ground, whatever its length, and balls take the same way.
BOOST_AUTO_TEST_CASE(bodies_on_hills_do_not_sink_in) {
  std::mt19937 random(3);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int k = 0; k < 16; ++k) {
    const double a = between(-1, 1), b = between(-1, 1), c = between(0, 6);
    const Heightfield hills = field({4, 4}, {13, 13}, [&](double x, double y) {
      return 0.12 * (a * std::sin(3 * x + c) + b * std::cos(2.5 * y - c)) + 0.05 * (x * x + y * y);
    });
    Body body = thrown(shapes()[static_cast<std::size_t>(k % 4)], {between(-0.5, 0.5), between(-0.5, 0.5), 1},
                       {between(-1, 1), between(-1, 1), 0});
    Scene scene;
    scene.gravity = {0, 0, -9.81};
    scene.bodies = {body, ground(hills)};
    scene.contact_default = {0, k % 3 == 0 ? 0.0 : 0.4};
    const std::vector<Collider> colliders = colliders_of(scene);
    ContactRun run(scene, "event", k % 2 == 0 ? "dormand-prince" : "rk4"), fine(scene, "event", "dormand-prince");
    double deepest = 0;
    for (int n = 0; n < 60; ++n) {
      run.step(1.0 / 30);
      deepest = std::min(deepest, gap_above_ground(colliders[0], pose_of(run.state(), 0), *hills.surface, {}));
    }
    BOOST_TEST(run.solver_warning() == "");
    BOOST_TEST(deepest > -1e-4, named(*body.shape, {0, 0}) << ": " << deepest);  // crowded steps may leave as much
    if (k % 4 != 0) continue;
    BOOST_TEST(deepest > -1e-12);
    fine.run(1.0 / 240, 480);
    BOOST_TEST((run.state().position(0) - fine.state().position(0)).norm() < 1e-8);
  }
}

// Of a box by its mesh: for a ball's centre in closed form, and for a corner.
BOOST_AUTO_TEST_CASE(the_gap_above_a_mesh_of_a_box_is_that_above_the_box) {
  std::mt19937 random(5);
  const auto between = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const Vec3 half(0.5, 0.4, 0.3);
  const Mesh mesh = mesh_of_box(2 * half);
  Scene scene;
  scene.bodies = {solid("ball", Sphere{0.2}, Vec3::Zero())};
  const std::vector<Collider> colliders = colliders_of(scene);
  for (int k = 0; k < 500; ++k) {
    const Vec3 p(between(-0.8, 0.8), between(-0.7, 0.7), between(-0.6, 0.6)), beyond = p.cwiseAbs() - half;
    const double distance =
        beyond.maxCoeff() <= 0 ? beyond.maxCoeff() : Vec3(beyond.cwiseMax(Vec3::Zero().eval())).norm();
    if (distance < -0.19) continue;  // deeper than is looked for
    if (distance > 0.39) continue;   // farther
    const double due = distance - 0.2;
    BOOST_TEST(std::abs(gap_above_ground(colliders[0], {p, Mat3::Identity()}, *mesh.surface, {}) - due) < 1e-12);
  }
}

BOOST_AUTO_TEST_SUITE_END()
