// Pendulums that hit a wall or each other, against impact times and states that others have worked out.
#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "tests/cases/judged.h"
#include "tests/core/dynamics/joints/jointed_run.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_joint_pendulum_impacts)

namespace {

BodyState state_at(const Truth& truth, double t, const Scene& scene, const std::string& body) {
  return test::truth_at(truth, t, scene.bodies.size()).columns().body(test::body_index(scene, body));
}

}  // namespace

// Published to thirteen digits: the height is that of the lowest point, and the speed turns round and is halved.
BOOST_AUTO_TEST_CASE(a_ball_hits_the_wall_when_it_should_and_leaves_with_half_its_speed) {
  const Scene scene = test::suite_scene("joints/pendulum-at-wall");
  const auto truth = make_truth("pendulum-impacts", scene, 5);
  BOOST_TEST(truth->error(5) < 1e-13);
  for (const double impact : {0.53848770880977, 1.5582790610076, 2.5657686822686, 3.5702855875748, 4.5740654575562}) {
    const BodyState before = state_at(*truth, impact - 1e-12, scene, "bob"),
                    after = state_at(*truth, impact + 1e-12, scene, "bob");
    BOOST_TEST((before.position - Vec3(0, -1, 0)).norm() < 1e-11);
    BOOST_TEST(before.velocity.x() < 0);
    BOOST_TEST(std::abs(after.velocity.x() + 0.5 * before.velocity.x()) < 1e-10);
    BOOST_TEST(std::abs(after.angular_velocity.z() - after.velocity.x()) < 1e-10);  // on 1 m
  }
}

BOOST_AUTO_TEST_CASE(what_comes_in_at_one_end_of_a_cradle_leaves_at_the_other) {
  const Scene scene = test::suite_scene("mechanisms/cradle");
  const auto truth = make_truth("pendulum-impacts", scene, 3);
  BOOST_TEST((state_at(*truth, 1, scene, "ball5").position - Vec3(0.899107860028, 0.133460131293, 0)).norm() < 2e-12);
  BOOST_TEST((state_at(*truth, 2, scene, "ball1").position - Vec3(-0.496431459005, 0.131924077911, 0)).norm() < 2e-12);
  for (const double t : {0.6, 1.0, 2.0, 2.9}) {
    for (const char* still : {"ball2", "ball3", "ball4"})
      BOOST_TEST(state_at(*truth, t, scene, still).velocity.norm() == 0);
  }
}

BOOST_AUTO_TEST_CASE(a_scene_it_does_not_hold_for_is_refused_with_the_reason) {
  struct Row {
    const char* scene;
    void (*spoil)(Scene&);
    const char* says;
  };
  const Row rows[] = {
      {"joints/pendulum-at-wall", [](Scene& s) { s.contact_default.friction = 0.1; }, "friction:coulomb"},
      {"joints/pendulum-at-wall", [](Scene& s) { std::get<Plane>(*s.bodies[1].shape).offset -= 0.01; }, "just where"},
      {"joints/pendulum-at-wall", [](Scene& s) { s.joints.push_back(s.joints[0]); }, "two joints"},
      {"joints/pendulum-at-wall", [](Scene& s) { s.gravity.setZero(); }, "no gravity"},
      {"mechanisms/cradle", [](Scene& s) { s.contact_default.restitution = 0.9; }, "lose energy"},
      {"mechanisms/cradle", [](Scene& s) { s.bodies[2].mass = 2; }, "alike"},
      {"mechanisms/cradle",
       [](Scene& s) {
         s.bodies[2].velocity = {0, 0, 1};
       },
       "from rest"},
      {"joints/pendulum-90", [](Scene&) {}, "1 balls and 0 walls"},
  };
  for (const Row& row : rows) {
    Scene scene = test::suite_scene(row.scene);
    row.spoil(scene);
    BOOST_TEST_CONTEXT(row.scene << ": " << row.says)
    BOOST_CHECK_EXCEPTION(make_truth("pendulum-impacts", scene, 3), InputError, test::says(row.says));
  }
}

BOOST_AUTO_TEST_SUITE_END()
