// The truth 'rolling-ellipsoid' against motions in closed form, conservation, and the core's contact by events.
#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>

#include "cases/truth/truth.h"
#include "core/base/error.h"
#include "core/dynamics/model/energy.h"
#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_rolling_ellipsoid)

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
  const auto truth = make_truth("rolling-ellipsoid", scene, 5);
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
  const auto truth = make_truth("rolling-ellipsoid", scene, 3);
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
  const auto truth = make_truth("rolling-ellipsoid", scene, 2);
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
    const auto changed = make_truth("rolling-ellipsoid", other, 2);
    BOOST_TEST(
        at(*truth, scene, 2).orientation.angularDistance(at(*changed, other, 2).orientation) > 1000 * truth->error(2),
        what);
  }
}

// Fast enough, the table would have to hold it down.
BOOST_AUTO_TEST_CASE(it_ends_where_the_plane_would_have_to_pull) {
  Scene scene = rattleback();
  Body& body = scene.bodies[0];
  body.angular_velocity = {0, 30, 0}, body.velocity = body.angular_velocity.cross(Vec3(0, 0, 0.02));
  const auto truth = make_truth("rolling-ellipsoid", scene, 1);
  BOOST_TEST(std::isinf(truth->error(1)));
}

BOOST_AUTO_TEST_CASE(it_ends_where_friction_would_leave_its_cone) {
  Scene scene = rattleback();
  const auto infinite = [&] {
    scene.contact_default.friction = kInfiniteFriction;
    return at(*make_truth("rolling-ellipsoid", scene, 3), scene, 3);
  }();
  scene.contact_default.friction = 1;
  BOOST_TEST((at(*make_truth("rolling-ellipsoid", scene, 3), scene, 3).position - infinite.position).norm() == 0);
  scene.contact_default.friction = 0.02;
  BOOST_TEST(std::isinf(make_truth("rolling-ellipsoid", scene, 3)->error(3)));
}

BOOST_AUTO_TEST_CASE(other_scenes_are_refused) {
  const std::pair<const char*, std::function<void(Scene&)>> kOthers[] = {
      {"its contact point starts", [](Scene& s) { s.bodies[0].velocity.x() += 1e-6; }},
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
    BOOST_CHECK_EXCEPTION(make_truth("rolling-ellipsoid", scene, 1), InputError, [why = why](const InputError& error) {
      return std::string(error.what()).find(why) != std::string::npos;
    });
  }
}

BOOST_AUTO_TEST_SUITE_END()
