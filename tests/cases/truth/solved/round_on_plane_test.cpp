// The truth 'round-on-plane' against motions in closed form, conservation, and the core's contact by events.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "cases/truth/truth.h"
#include "core/base/error.h"
#include "core/dynamics/model/energy.h"
#include "tests/cases/judged.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_round_on_plane)

namespace {

Scene rattleback() { return test::suite_scene("contact/rattleback"); }

BodyState at(const Truth& truth, const Scene& scene, double t) {
  return test::truth_at(truth, t, scene.bodies.size()).columns().body(0);
}

// A ball on a slope's worth of nothing: level ground, where it rolls on at its speed.
Scene ball() {
  Scene scene = rattleback();
  Body& one = scene.bodies[0];
  one.shape = Ellipsoid{{0.1, 0.1, 0.1}}, one.inertia = 0.001 * Mat3::Identity(), one.position = {0, 0, 0.1};
  one.angular_velocity = {0, 4, 0}, one.velocity = {0.4, 0, 0};
  return scene;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_ball_rolls_on_at_its_speed) {
  const Scene scene = ball();
  const auto truth = make_truth("round-on-plane", scene, 5);
  BOOST_TEST(truth->error(5) < 1e-13);
  for (const double t : {0.3, 2.0, 5.0}) {
    const BodyState ball = at(*truth, scene, t);
    BOOST_TEST((ball.position - Vec3(0.4 * t, 0, 0.1)).norm() < 1e-13);
    BOOST_TEST(ball.orientation.angularDistance(rotation_by({0, 4 * t, 0})) < 1e-12);
  }
}

// Its lowest point stays on the plane and at rest, and rolling does no work.
BOOST_AUTO_TEST_CASE(a_rattleback_keeps_its_contact_and_its_energy_and_turns_round) {
  const Scene scene = rattleback();
  const auto truth = make_truth("round-on-plane", scene, 3);
  BOOST_TEST(truth->error(3) < 1e-9);
  const double before = energy(scene, test::truth_at(*truth, 0, 2).columns());
  for (double t = 0.1; t < 3; t += 0.1) {
    const BodyTable table = test::truth_at(*truth, t, 2);
    const BodyState now = table.columns().body(0);
    const Vec3 lowest =
        now.orientation *
        std::get<Ellipsoid>(*scene.bodies[0].shape).support(now.orientation.conjugate() * Vec3(0, 0, -1));
    BOOST_TEST(std::abs(now.position.z() + lowest.z()) < 1e-12);
    BOOST_TEST((now.velocity + now.angular_velocity.cross(lowest)).norm() < 1e-12);
    BOOST_TEST(std::abs(energy(scene, table.columns()) - before) < 1e-11 * before);
  }
  BOOST_TEST(at(*truth, scene, 0).angular_velocity.z() < -2.9);
  BOOST_TEST(at(*truth, scene, 3).angular_velocity.z() > 0.5);
}

// A change of its inertia by a thousandth is far outside what it claims.
BOOST_AUTO_TEST_CASE(it_depends_on_all_of_the_scene) {
  const Scene scene = rattleback();
  const auto truth = make_truth("round-on-plane", scene, 2);
  const std::pair<const char*, std::function<void(Scene&)>> kChanges[] = {
      {"inertia", [](Scene& s) { s.bodies[0].inertia(2, 2) *= 1.001; }},
      {"mass", [](Scene& s) { s.bodies[0].mass *= 1.001; }},
      {"gravity", [](Scene& s) { s.gravity *= 1.001; }},
      {"shape", [](Scene& s) {
         s.bodies[0].shape = Ellipsoid{{0.2002, 0.03, 0.02}};
       }}};
  for (const auto& [what, change] : kChanges) {
    Scene other = scene;
    change(other);
    const auto changed = make_truth("round-on-plane", other, 2);
    BOOST_TEST(
        at(*truth, scene, 2).orientation.angularDistance(at(*changed, other, 2).orientation) > 1000 * truth->error(2),
        what);
  }
}

double tilt(const BodyState& body) { return std::acos((body.orientation * Vec3::UnitZ()).z()); }

// Its lower rim stays on the table and at rest. While it falls, its contact runs round threefold as fast.
BOOST_AUTO_TEST_CASE(a_disk_keeps_its_contact_and_its_energy_and_its_rate_rises) {
  const Scene scene = test::suite_scene("contact/eulers-disk");
  const auto truth = make_truth("round-on-plane", scene, 1);
  BOOST_TEST(truth->error(1) < 1e-9);
  const auto [radius, length] = std::get<Cylinder>(*scene.bodies[0].shape);
  const double before = energy(scene, test::truth_at(*truth, 0, 2).columns());
  double slowest = 1e9, fastest = 0, heading = std::numbers::pi / -2;
  for (double t = 0.001; t < 1; t += 0.001) {
    const BodyTable table = test::truth_at(*truth, t, 2);
    const BodyState now = table.columns().body(0);
    const Vec3 axis = now.orientation * Vec3::UnitZ(), level = Vec3(axis.x(), axis.y(), 0).normalized(),
               lowest = -0.5 * length * axis + radius * (axis.z() * level - axis.head<2>().norm() * Vec3::UnitZ());
    BOOST_TEST(std::abs(now.position.z() + lowest.z()) < 1e-12);
    BOOST_TEST((now.velocity + now.angular_velocity.cross(lowest)).norm() < 1e-11);
    BOOST_TEST(std::abs(energy(scene, table.columns()) - before) < 1e-11 * before);
    const double to = std::atan2(level.y(), level.x()),
                 rate = std::abs(std::remainder(to - heading, 2 * std::numbers::pi)) / 0.001;
    slowest = std::min(slowest, rate), fastest = std::max(fastest, rate), heading = to;
  }
  BOOST_TEST(fastest > 3 * slowest);
}

// Steady: the disk's middle stays where it is, and its axis goes round at Omega² = 4 g/(r sin(tilt)), for a disk that
// has no thickness (Kessler and O'Reilly 2002). One of 1e-9 of its radius is as good.
BOOST_AUTO_TEST_CASE(a_thin_disk_precesses_at_the_published_rate) {
  constexpr double kTilt = 0.3, kRadius = 0.05, kThickness = 1e-9 * kRadius;
  Scene scene = test::suite_scene("contact/eulers-disk");
  scene.contact_default.friction = kInfiniteFriction;
  Body& disk = scene.bodies[0];
  const double rate = std::sqrt(4 * 9.81 / (kRadius * std::sin(kTilt)));
  disk.shape = Cylinder{kRadius, kThickness};
  disk.inertia = disk.mass * kRadius * kRadius * Vec3(0.25, 0.25, 0.5).asDiagonal().toDenseMatrix();
  disk.orientation = rotation_by({kTilt, 0, 0});
  const Vec3 axis = disk.orientation * Vec3::UnitZ(), down(0, -std::cos(kTilt), -std::sin(kTilt)),
             lowest = kRadius * down - 0.5 * kThickness * axis;
  disk.position = {0, 0, -lowest.z()};
  disk.angular_velocity = rate * std::sin(kTilt) * down;
  disk.velocity = -disk.angular_velocity.cross(lowest);
  const auto truth = make_truth("round-on-plane", scene, 1);
  for (double t = 0.05; t < 1; t += 0.05) {
    const BodyState now = at(*truth, scene, t);
    const Vec3 around = now.orientation * Vec3::UnitZ(), expected = rotation_by({0, 0, -rate * t}) * axis;
    BOOST_TEST((around - expected).norm() < 1e-6);
    BOOST_TEST((now.position - disk.position).norm() < 1e-8);
  }
}

// What a ball that slides keeps, whatever the friction: Jellett's integral, L . r (Cohen, Am. J. Phys. 45, 1977). Its
// energy falls by what friction takes: the integral of mu N |u|, with N from the acceleration of the centre of mass.
BOOST_AUTO_TEST_CASE(a_tippe_top_keeps_jelletts_integral_and_loses_what_friction_takes) {
  const Scene scene = test::suite_scene("contact/tippe-top");
  const auto truth = make_truth("round-on-plane", scene, 1);
  BOOST_TEST(truth->error(1) < 1e-9);
  const Body& top = scene.bodies[0];
  const auto arm = [](const BodyState& now) -> Vec3 {
    return now.orientation * Vec3(0, 0, 0.006) - 0.02 * Vec3::UnitZ();
  };
  const auto jellett = [&](const BodyState& now) {
    const Mat3 R = now.orientation.toRotationMatrix();
    return (R * top.inertia * R.transpose() * now.angular_velocity).dot(arm(now));
  };
  // W; N to the square of the step, some 1e-5 of it
  const auto power = [&](double t) {
    constexpr double kStep = 1e-4;
    const BodyState now = at(*truth, scene, t);
    const double rise = at(*truth, scene, t + kStep).velocity.z() - at(*truth, scene, t - kStep).velocity.z();
    const Vec3 slip = now.velocity + now.angular_velocity.cross(arm(now));
    BOOST_TEST(std::abs(slip.z()) < 1e-11);
    return 0.3 * top.mass * (9.81 + rise / (2 * kStep)) * slip.norm();
  };
  const double of_start = jellett(at(*truth, scene, 0));
  constexpr int kPieces = 1000;
  constexpr double kFrom = 0.05, kPiece = 0.9 / kPieces;
  double taken = 0;  // J, by Simpson's rule
  for (int k = 0; k < kPieces; ++k) {
    const double t = kFrom + k * kPiece;
    taken += kPiece / 6 * (power(t) + 4 * power(t + 0.5 * kPiece) + power(t + kPiece));
    BOOST_TEST(std::abs(jellett(at(*truth, scene, t)) - of_start) < 1e-9 * std::abs(of_start));
  }
  const auto energy_at = [&](double t) { return energy(scene, test::truth_at(*truth, t, 2).columns()); };
  const double lost = energy_at(kFrom) - energy_at(kFrom + 0.9);
  BOOST_TEST(lost > 0.3 * energy_at(0));
  BOOST_TEST(std::abs(taken - lost) < 1e-4 * lost);
  BOOST_TEST(tilt(at(*truth, scene, 1)) > 2.7);
}

// How a flat end shares its force is not known, and contact by events takes four points of its rim.
BOOST_AUTO_TEST_CASE(the_truth_of_events_ends_where_a_cylinder_lies_flat) {
  Scene scene = test::suite_scene("contact/eulers-disk");
  scene.bodies[0].velocity.setZero(), scene.bodies[0].angular_velocity.setZero();
  const auto events = make_truth("events", scene, 0.3), rolling = make_truth("round-on-plane", scene, 0.05);
  BOOST_TEST(events->error(0.05) < 1e-7);
  BOOST_TEST((at(*events, scene, 0.05).position - at(*rolling, scene, 0.05).position).norm() < 1e-9);
  BOOST_TEST(std::isinf(events->error(0.3)));
}

// Fast enough, the table would have to hold it down.
BOOST_AUTO_TEST_CASE(it_ends_where_the_plane_would_have_to_pull) {
  Scene scene = rattleback();
  Body& body = scene.bodies[0];
  body.angular_velocity = {0, 30, 0}, body.velocity = body.angular_velocity.cross(Vec3(0, 0, 0.02));
  const auto truth = make_truth("round-on-plane", scene, 1);
  BOOST_TEST(std::isinf(truth->error(1)));
}

BOOST_AUTO_TEST_CASE(it_ends_where_friction_would_leave_its_cone) {
  Scene scene = rattleback();
  const auto infinite = [&] {
    scene.contact_default.friction = kInfiniteFriction;
    return at(*make_truth("round-on-plane", scene, 3), scene, 3);
  }();
  scene.contact_default.friction = 1;
  BOOST_TEST((at(*make_truth("round-on-plane", scene, 3), scene, 3).position - infinite.position).norm() == 0);
  scene.contact_default.friction = 0.02;
  BOOST_TEST(std::isinf(make_truth("round-on-plane", scene, 3)->error(3)));
}

BOOST_AUTO_TEST_CASE(other_scenes_are_refused) {
  const std::pair<const char*, std::function<void(Scene&)>> kOthers[] = {
      {"too little to slide", [](Scene& s) { s.bodies[0].velocity.x() += 1e-9; }},
      {"starts upwards", [](Scene& s) { s.bodies[0].velocity.z() += 1e-6; }},
      {"under infinite friction",
       [](Scene& s) {
         s.bodies[0].velocity.x() += 1;
         s.contact_default.friction = kInfiniteFriction;
       }},
      {"another shape",
       [](Scene& s) {
         s.bodies[0].shape = Box{{0.1, 0.1, 0.1}};
       }},
      {"lies on its side",
       [](Scene& s) {
         s.bodies[0].shape = Cylinder{0.02, 0.1}, s.bodies[0].orientation = rotation_by({0.5 * std::numbers::pi, 0, 0});
       }},
      {"its end lies flat",
       [](Scene& s) {
         s.bodies[0].shape = Cylinder{0.02, 0.1};
       }},
      {"above", [](Scene& s) { s.bodies[0].position.z() += 1e-6; }},
      {"friction has to hold it", [](Scene& s) { s.contact_default.friction = 0; }},
      {"gravity is not against",
       [](Scene& s) {
         s.gravity = {1, 0, -9};
       }},
      {"is neither", [](Scene& s) { s.bodies.push_back(s.bodies[0]); }},
      {"something else acts", [](Scene& s) { s.forces.emplace_back().body = 0; }},
      {"there is no plane", [](Scene& s) { s.bodies.pop_back(); }}};
  for (const auto& [why, change] : kOthers) {
    Scene scene = rattleback();
    change(scene);
    BOOST_CHECK_EXCEPTION(make_truth("round-on-plane", scene, 1), InputError, [why = why](const InputError& error) {
      return std::string(error.what()).find(why) != std::string::npos;
    });
  }
}

BOOST_AUTO_TEST_SUITE_END()
