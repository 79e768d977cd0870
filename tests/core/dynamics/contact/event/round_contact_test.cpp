// Curved surfaces in contact by events: ellipsoids, and a ball on a cylinder. The point of contact moves over the body.
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "core/dynamics/contact/event/features/contact_kinematics.h"
#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/contact/event/event_ends.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_round_contact)

namespace {

constexpr double kG = 9.81;

using Law = std::pair<double, double>;  // restitution and friction
constexpr Law kLaws[] = {{0, 0}, {0.5, 0.3}, {0, 0.4}, {0.8, 0.1}};

Body fixed_body(const Shape& shape, const Vec3& position, const Quat& orientation = Quat::Identity()) {
  Body body = solid("support", shape, position);
  body.fixed = true, body.orientation = orientation;
  return body;
}

Scene two_bodies(const Body& above, const Body& below, const Law& law) {
  Scene scene;
  scene.gravity = {0, 0, -kG};
  scene.bodies = {above, below};
  scene.contact_default = {law.first, law.second};
  return scene;
}

Body thrown(const Shape& shape, const Vec3& position) {
  Body body = solid("thrown", shape, position);
  body.velocity = {1, 0.2, 0}, body.angular_velocity = {3, 5, 1};
  return body;
}

// A rattleback: an ellipsoid whose principal axes of inertia are turned by 0.1 rad against its half-axes.
struct Rattleback {
  const Vec3 radii{0.2, 0.03, 0.02}, spin{0.3, 0.2, -3};
  Mat3 inertia = inertia_about(0.1);

  static Mat3 inertia_about(double turn) {
    const Mat3 R = matrix_of(rotation_by({0, 0, turn}));
    return R * Vec3(2e-4, 1.6e-3, 1.7e-3).asDiagonal() * R.transpose();
  }

  Scene scene() const {
    Body body = solid("rattleback", Ellipsoid{radii}, {0, 0, radii.z()});
    body.inertia = inertia;
    body.angular_velocity = spin, body.velocity = spin.cross(Vec3(0, 0, radii.z()));  // it rolls
    return on_floor({body}, {0, kInfiniteFriction});
  }
};

// The same in the frame of the body, without any position: with the upward direction g = R^T z, the contact at r(g)
// from the centre and v = r x w,
//   (I - m [r]x [r]x) w' = -w x I w + m r x (r' x w + w x (r x w) + G g),   g' = g x w.
// (Walker, On a dynamical top, 1896; Bondi, The rigid body dynamics of unidirectional spin, 1986.)
struct RollingInBody {
  using State = std::array<Vec3, 2>;  // g and w
  const Rattleback& of;

  State rate(const State& at) const {
    const Vec3 &g = at[0], &w = at[1], squares = of.radii.cwiseAbs2(), g_rate = g.cross(w);
    const double length = of.radii.cwiseProduct(g).norm(), length_rate = squares.cwiseProduct(g).dot(g_rate) / length;
    const Vec3 r = -squares.cwiseProduct(g) / length,
               r_rate = -squares.cwiseProduct(g_rate) / length - r * (length_rate / length);
    const Mat3 across = cross_matrix(r), left = of.inertia - across * across;
    const Vec3 right = -w.cross(of.inertia * w) + r.cross(r_rate.cross(w) + w.cross(r.cross(w)) + kG * g);
    return {g_rate, left.inverse() * right};
  }

  // By the classical Runge-Kutta method.
  State after(double t, int steps) const {
    State at = {Vec3::UnitZ(), of.spin};
    const double h = t / steps;
    const auto moved = [](const State& from, const State& by, double f) {
      return State{from[0] + f * by[0], from[1] + f * by[1]};
    };
    for (int n = 0; n < steps; ++n) {
      const State k1 = rate(at), k2 = rate(moved(at, k1, 0.5 * h)), k3 = rate(moved(at, k2, 0.5 * h)),
                  k4 = rate(moved(at, k3, h));
      for (int i = 0; i < 2; ++i) at[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    }
    return at;
  }

  // Of a run's state.
  static State seen(const BodyTable& table) {
    const Mat3 R = matrix_of(table.columns().orientation(0));
    return {R.transpose() * Vec3::UnitZ(), R.transpose() * table.columns().angular_velocity(0)};
  }
};

double error_of_rattleback(const char* integrator, double t, int steps, const RollingInBody::State& due) {
  const RollingInBody::State is = RollingInBody::seen(event_end(Rattleback().scene(), integrator, t / steps, steps));
  return (is[0] - due[0]).norm() + 0.1 * (is[1] - due[1]).norm();
}

}  // namespace

BOOST_AUTO_TEST_CASE(an_ellipsoid_of_equal_half_axes_moves_as_the_ball_does) {
  const Ellipsoid round{{0.2, 0.2, 0.2}};
  for (const Law& law : kLaws) {
    const Body ball = thrown(Sphere{0.2}, {0, 0, 0.5}), ellipsoid = thrown(round, {0, 0, 0.5});
    BOOST_TEST_CONTEXT("e = " << law.first << ", mu = " << law.second) {
      BOOST_TEST(first_body_apart(event_end(on_floor({ball}, {law.first, law.second}), "dormand-prince", 1.0 / 60, 60),
                                  event_end(on_floor({ellipsoid}, {law.first, law.second}), "dormand-prince", 1.0 / 60,
                                            60)) < 1e-12);
      const Body below = fixed_body(Sphere{0.5}, {0.02, 0, -0.3}),
                 round_below = fixed_body(Ellipsoid{{0.5, 0.5, 0.5}}, {0.02, 0, -0.3});
      const BodyTable due = event_end(two_bodies(ball, below, law), "dormand-prince", 1.0 / 60, 36);
      BOOST_TEST(first_body_apart(due, event_end(two_bodies(ellipsoid, below, law), "dormand-prince", 1.0 / 60, 36)) <
                 1e-12);
      BOOST_TEST(first_body_apart(due, event_end(two_bodies(ball, round_below, law), "dormand-prince", 1.0 / 60, 36)) <
                 1e-12);
    }
  }
}

// The spin of -3 rad/s turns round on its way.
BOOST_AUTO_TEST_CASE(a_rattleback_follows_the_equations_of_rolling) {
  const Rattleback rattleback;
  const RollingInBody::State due = RollingInBody{rattleback}.after(2, 200000);
  BOOST_TEST(due[1].z() > 1);
  BOOST_TEST(error_of_rattleback("dormand-prince", 2, 120, due) < 1e-8);
  const double coarse = error_of_rattleback("rk4", 2, 1920, due), fine = error_of_rattleback("rk4", 2, 3840, due);
  BOOST_TEST(std::log2(coarse / fine) > 3.8, coarse << ", " << fine);
}

BOOST_AUTO_TEST_CASE(an_ellipsoid_that_slides_without_friction_keeps_its_energy_and_its_spin_about_the_vertical) {
  Body body = solid("ellipsoid", Ellipsoid{{0.2, 0.1, 0.05}}, Vec3::Zero());
  body.orientation = rotation_by({0.3, 0.5, 0.1});
  body.position.z() = Vec3(0.2, 0.1, 0.05).cwiseProduct(body.orientation.conjugate() * Vec3::UnitZ()).norm();
  body.angular_velocity = {0, 0, 4};  // its lowest point moves along the floor
  const Scene scene = on_floor({body}, {0, 0});
  const auto spin_of = [&](BodyColumns state) {
    const Mat3 R = matrix_of(state.orientation(0));
    return (R * body.inertia * R.transpose() * state.angular_velocity(0)).z();
  };
  ContactRun run(scene, "event", "dormand-prince");
  const double energy = rigor::energy(scene, run.state()), spin = spin_of(run.state());
  run.run(1.0 / 120, 60);
  BOOST_TEST(run.solver_warning() == "");
  BOOST_TEST(std::abs(rigor::energy(scene, run.state()) - energy) < 1e-10);
  BOOST_TEST(std::abs(spin_of(run.state()) - spin) < 1e-11);
}

// On its side a cylinder is a capsule, on its cap a box, and past its rim, in the plane through its axis, the box's
// edge.
BOOST_AUTO_TEST_CASE(a_ball_moves_over_a_cylinder_as_over_the_shapes_that_it_is_in_part) {
  const Quat level = rotation_by({0.5 * std::numbers::pi, 0, 0});
  for (const Law& law : kLaws) {
    const Body ball = thrown(Sphere{0.1}, {0.02, 0, 0.4});
    BOOST_TEST_CONTEXT("e = " << law.first << ", mu = " << law.second) {
      BOOST_TEST(first_body_apart(event_end(two_bodies(ball, fixed_body(Capsule{0.2, 3}, Vec3::Zero(), level), law),
                                            "dormand-prince", 1.0 / 60, 24),
                                  event_end(two_bodies(ball, fixed_body(Cylinder{0.2, 3}, Vec3::Zero(), level), law),
                                            "dormand-prince", 1.0 / 60, 24)) < 1e-12);
      Body straight = ball;
      straight.velocity = {1, 0, 0}, straight.angular_velocity = {0, 8, 0};
      const Body box = fixed_body(Box{{0.6, 0.6, 0.4}}, Vec3::Zero()),
                 cylinder = fixed_body(Cylinder{0.3, 0.4}, Vec3::Zero());
      BOOST_TEST(first_body_apart(event_end(two_bodies(straight, box, law), "dormand-prince", 1.0 / 60, 36),
                                  event_end(two_bodies(straight, cylinder, law), "dormand-prince", 1.0 / 60, 36)) <
                 1e-10);
    }
  }
}

// The rates of the contact's place and normal against differences, for bodies that move anyhow.
BOOST_AUTO_TEST_CASE(the_place_of_a_contact_moves_at_its_rate) {
  ContactFeature ellipsoid{.kind = ContactFeature::Kind::round, .at = {0.05, -0.1, 0.02}};
  ellipsoid.half_axes = matrix_of(rotation_by({0.2, 0.5, -0.3})) * Vec3(0.5, 0.3, 0.2).asDiagonal();
  ContactFeature rim{.kind = ContactFeature::Kind::round, .at = {0, 0, 0.2}, .direction = Vec3::UnitX()};
  rim.half_axes.diagonal() = Vec3(0.3, 0.3, 0);
  const ContactFeature plane{.kind = ContactFeature::Kind::plane, .at = {0, 0.1, 0}, .direction = {0.6, 0, 0.8}},
      ball{.at = {1.2, -0.3, 0}, .radius = 0.2, .is_vertex = true};
  const RigidMotion a{{{0.4, 0.1, 1.1}, matrix_of(rotation_by({0.1, 0.4, 0.2}))}, {0.3, -0.2, 0.1}, {1, -0.5, 0.7}},
      b{{{0, 0, 0.1}, matrix_of(rotation_by({-0.1, 0.1, 0.3}))}, {0.1, 0.2, -0.4}, {0.3, 0.6, -0.2}};
  const auto moved = [](RigidMotion from, double t) {
    from.pose.p += t * from.v, from.pose.R = matrix_of(rotation_by(t * from.w)) * from.pose.R;
    return from;
  };
  for (const ContactFeature& round : {ellipsoid, rim}) {
    for (ContactFeature other : {plane, ball}) {
      for (const bool is_first : {true, false}) {
        FeaturePair features = is_first ? FeaturePair{round, other} : FeaturePair{other, round};
        const auto at = [&](double t) {
          return contact_kinematics(features, moved(is_first ? a : b, t), moved(is_first ? b : a, t));
        };
        // Rates belong to a closed gap: the ball's radius, or the place of the plane, closes it.
        const double gap = at(0).gap;
        for (ContactFeature* side : {&features.a, &features.b}) {
          if (side->kind == ContactFeature::Kind::plane) side->at += gap * side->direction;
          if (side->kind == ContactFeature::Kind::point) side->radius += gap;
        }
        constexpr double h = 1e-5;
        const ContactKinematics now = at(0), before = at(-h), after = at(h);
        BOOST_TEST(std::abs(now.gap) < 1e-14);
        BOOST_TEST(((after.normal - before.normal) / (2 * h) - now.normal_rate).norm() < 1e-8);
        // Midway between the surfaces, the gap that opens moves the place by half of it.
        const Vec3 opens = (after.gap - before.gap) / (4 * h) * now.normal * (is_first ? 1 : -1);
        const Vec3 found = (after.point - before.point) / (2 * h);
        BOOST_TEST(std::min((found - now.point_rate - opens).norm(), (found - now.point_rate + opens).norm()) < 1e-8);
      }
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
