// A cylinder on a plane by events: on one point of a rim, on its side, and flat on an end.
#include <boost/math/quadrature/gauss_kronrod.hpp>
#include <cmath>
#include <numbers>

#include "core/dynamics/model/energy.h"
#include "tests/core/dynamics/contact/event/event_ends.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(core_dynamics_contact_event_rim_contact)

namespace {

constexpr double kG = 9.81;

using Law = std::pair<double, double>;  // restitution and friction

// A cylinder that leans by `tilt` on the floor, over the point of its rim in the direction of x.
Body leaning(const Cylinder& shape, double tilt) {
  Body body = solid("cylinder", shape, Vec3::Zero());
  body.orientation = rotation_by({0, tilt, 0});
  body.position.z() = shape.radius * std::sin(tilt) + 0.5 * shape.length * std::cos(tilt);
  return body;
}

// It rolls about the point that it touches with.
Body rolling(Body body, const Cylinder& shape, double tilt, const Vec3& turning) {
  const Vec3 lowest = body.orientation * Vec3(shape.radius, 0, -0.5 * shape.length);
  BOOST_TEST(std::abs(lowest.z() + body.position.z()) < 1e-15);
  BOOST_TEST(tilt > 0);
  body.angular_velocity = turning, body.velocity = -turning.cross(lowest);
  return body;
}

// s: from rest at `tilt` until it lies flat, over a point that stays where it is. With the distance c from that point
// to the centre, which lies at the angle a above the end's plane, and the moment of inertia J about the point,
// J tilt'^2 = 2 m g c (sin(a + tilt0) - sin(a + tilt)).
double time_to_fall(const Body& body, const Cylinder& shape, double tilt) {
  const double half = 0.5 * shape.length, c = std::hypot(shape.radius, half), a = std::atan2(half, shape.radius),
               moment = body.inertia(1, 1) + body.mass * c * c;
  const auto slowness = [&](double s) {  // with tilt = tilt0 - s²: the speed vanishes at s = 0
    const double fallen = 2 * std::cos(a + tilt - 0.5 * s * s) * std::sin(0.5 * s * s);
    return 2 * s / std::sqrt(2 * body.mass * kG * c / moment * fallen);
  };
  return boost::math::quadrature::gauss_kronrod<double, 31>::integrate(slowness, 0, std::sqrt(tilt));
}

}  // namespace

// A capsule touches with its ends, straight below the same points.
BOOST_AUTO_TEST_CASE(a_level_cylinder_moves_as_a_capsule_does) {
  const Cylinder cylinder{0.2, 0.6};
  const Capsule capsule{0.2, 0.6};
  for (const Law& law : {Law{0, 0}, {0.5, 0.3}, {0, 0.4}, {0, kInfiniteFriction}}) {
    Body body = solid("lying", cylinder, {0, 0, 0.5});
    body.orientation = rotation_by({0.5 * std::numbers::pi, 0, 0});
    body.velocity = {1, 0, 0}, body.angular_velocity = {0, -3, 0};
    const BodyTable rolled = event_end(on_floor({body}, {law.first, law.second}), "dormand-prince", 1.0 / 60, 60);
    Body other = body;
    other.shape = capsule;
    const BodyTable due = event_end(on_floor({other}, {law.first, law.second}), "dormand-prince", 1.0 / 60, 60);
    BOOST_TEST(first_body_apart(rolled, due) < 1e-11, "e = " << law.first << ", mu = " << law.second);
  }
}

BOOST_AUTO_TEST_CASE(a_cylinder_that_leans_falls_flat_at_the_time_of_a_pendulum) {
  for (const auto& [tilt, shape] : {std::pair(0.3, Cylinder{0.2, 0.1}), {0.02, Cylinder{0.1, 0.3}}}) {
    const Body body = leaning(shape, tilt);
    const Scene scene = on_floor({body}, {0, kInfiniteFriction});
    ContactRun run(scene, "event", "dormand-prince");
    const double due = time_to_fall(body, shape, tilt), dt = due / 10.5, flat = 0.5 * shape.length;
    run.run(dt, 10);
    BOOST_TEST(!run.reduced_order());
    run.run(dt, 1);
    BOOST_REQUIRE(run.reduced_order());
    BOOST_TEST(std::abs(run.reduced_order()->from - due) < 1e-9);
    BOOST_TEST(run.reduced_order()->how.find("flat end of a cylinder") != std::string::npos);
    BOOST_TEST(run.solver_warning() == "");
    // Over the opposite point it keeps this share of its speed; where that is negative, it stops (Housner 1963).
    const double own = body.inertia(1, 1) / body.mass + flat * flat, square = shape.radius * shape.radius,
                 share = std::max(0.0, (own - square) / (own + square));
    const double left = energy(scene, BodyTable(run.state()).columns()) - body.mass * kG * flat;
    BOOST_TEST(std::abs(left - share * share * body.mass * kG * (body.position.z() - flat)) < 1e-9);
  }
}

// In a body of several shapes, the cylinder's points and ends are found in its part.
BOOST_AUTO_TEST_CASE(a_cylinder_as_a_part_moves_as_one_alone) {
  const Cylinder shape{0.05, 0.01};
  Body alone = rolling(leaning(shape, 0.4), shape, 0.4, {0.3, -4, 1});
  Body part = alone;
  const Quat turned = rotation_by({0.3, 0.2, 0.1});
  part.shape = Compound{{PlacedShape{shape, {Vec3::Zero(), turned}}}};
  part.orientation = alone.orientation * turned.conjugate();
  part.inertia = turned.toRotationMatrix() * alone.inertia * turned.toRotationMatrix().transpose();
  const auto end = [](const Body& body) {
    return event_end(on_floor({body}, {0, kInfiniteFriction}), "dormand-prince", 1.0 / 240, 120);
  };
  const BodyTable due = end(alone), is = end(part);
  BOOST_TEST((due.columns().position(0) - is.columns().position(0)).norm() < 1e-10);
  BOOST_TEST((due.columns().angular_velocity(0) - is.columns().angular_velocity(0)).norm() < 1e-8);
}

// Long steps in which the contact runs round the rim more than once.
BOOST_AUTO_TEST_CASE(a_disk_keeps_its_energy_and_its_contact_however_long_the_step) {
  const Cylinder shape{0.04, 0.002};
  for (const double tilt : {0.6, 0.1, 0.006}) {
    const double rate = std::sqrt(4 * kG / (shape.radius * std::sin(tilt)));
    const Body body =
        rolling(leaning(shape, tilt), shape, tilt, rate * std::sin(tilt) * Vec3(std::cos(tilt), 0, -std::sin(tilt)));
    const Scene scene = on_floor({body}, {0, kInfiniteFriction});
    const double before = energy(scene, BodyTable(ContactRun(scene, "event", "dormand-prince").state()).columns());
    const BodyTable end = event_end(scene, "dormand-prince", 1.0 / 30, 15);
    BOOST_TEST(std::abs(energy(scene, end.columns()) - before) < 1e-10 * before, tilt);
    const Vec3 axis = end.columns().orientation(0) * Vec3::UnitZ();
    const double height = shape.radius * axis.head<2>().norm() + 0.5 * shape.length * axis.z();
    BOOST_TEST(std::abs(end.columns().position(0).z() - height) < 1e-13, tilt);
  }
}

// Four points hold it where it stands; what passes through flat without contact is no such end.
BOOST_AUTO_TEST_CASE(only_a_flat_end_in_contact_reduces_the_order) {
  const Cylinder shape{0.1, 0.4};
  ContactRun stands(on_floor({leaning(shape, 0)}, {0.5, 0.5}), "event", "rk4");
  stands.run(0.01, 10);
  BOOST_REQUIRE(stands.reduced_order());
  BOOST_TEST(stands.reduced_order()->from == 0);
  Body flies = leaning(shape, 0);
  flies.position.z() += 1, flies.angular_velocity = {0, 3, 0}, flies.orientation = rotation_by({0, -0.05, 0});
  ContactRun flying(on_floor({flies}, {0.5, 0.5}), "event", "rk4");
  flying.run(0.01, 10);
  BOOST_TEST(!flying.reduced_order());
}

BOOST_AUTO_TEST_SUITE_END()
