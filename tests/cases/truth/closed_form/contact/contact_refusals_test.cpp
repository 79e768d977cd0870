// Each closed form of contact says what the scene would have to be.
#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_contact_contact_refusals)

namespace {

const Box kBox{{0.4, 0.4, 0.2}};
const Sphere kBall{0.5};

struct Row {
  const char* truth;
  Scene scene;
  void (*spoil)(Scene&);
  const char* says;
};

const Row kRows[] = {
    {"rolling", test::on_slope(kBall, 0.1, 0.5, 1), [](Scene& s) { s.bodies[0].position.z() += 0.1; },
     "above the plane"},
    {"rolling", test::on_slope(kBall, 0.1, 0.5, 1), [](Scene& s) { s.bodies[0].velocity.z() += 1; },
     "leaves or enters"},
    {"rolling", test::on_slope(kBall, 0.1, 0.5, 1), [](Scene& s) { s.bodies[0].velocity.y() += 1; }, "its path bends"},
    {"rolling", test::on_slope(kBall, 0, 0.5, 1), [](Scene& s) { s.bodies[0].angular_velocity.z() = 1; },
     "spins about"},
    {"rolling", test::on_slope(kBall, 0, 0.5, 1), [](Scene& s) { s.contact_default.friction = kInfiniteFriction; },
     "infinite friction would end"},
    {"rolling", test::on_slope(kBall, 0, 0.5, 1), [](Scene& s) { s.bodies[0].inertia(0, 0) *= 2; }, "every axis"},
    {"rolling", test::on_slope(kBall, 0, 0.5, 1), [](Scene& s) { s.gravity.setZero(); }, "does not press"},
    {"rolling", test::on_slope(kBall, 0, 0.5, 1), [](Scene& s) { s.bodies.push_back(s.bodies[1]); }, "second plane"},
    {"rolling", test::on_slope(kBall, 0, 0.5, 1),
     [](Scene& s) { s.bodies.push_back(s.bodies[0]), s.bodies[2].position.x() += 2, s.bodies[2].velocity.setZero(); },
     "could touch"},
    {"rolling", test::on_slope(kBall, 0, 0.5, 1), [](Scene& s) { s.forces.emplace_back().body = 0; }, "timed-force"},
    {"sliding", test::on_slope(kBox, 0, 0.5, 1), [](Scene& s) { s.bodies[0].angular_velocity.z() = 1; }, "turns"},
    {"sliding", test::on_slope(kBox, 0, 0.5, 1), [](Scene& s) { s.contact_default.friction = 2.1; }, "would tip over"},
    {"sliding", test::on_slope(kBox, 0.1, 0.5, 1), [](Scene& s) { s.bodies[0].velocity.y() += 1; }, "its path bends"},
    {"sliding", test::on_slope(kBox, 0, 0.5, 1),
     [](Scene& s) {
       s.bodies[0].orientation = rotation_by({0.1, 0, 0}), s.bodies[0].position.z() += 0.05;
     },
     "above the plane"},
    {"line-impacts", test::row_of_spheres(3, 0.1, 1), [](Scene& s) { s.gravity.z() = -1; }, "there is gravity"},
    {"line-impacts", test::row_of_spheres(3, 0.1, 1), [](Scene& s) { s.bodies[1].position.y() = 0.1; },
     "beside the line"},
    {"line-impacts", test::row_of_spheres(3, 0.1, 1), [](Scene& s) { s.bodies[1].position.x() = 2; }, "overlap"},
    {"line-impacts", test::row_of_spheres(3, 0.1, 1),
     [](Scene& s) {
       s.bodies[1].shape = kBox, s.bodies[1].orientation = rotation_by({0, 0, 0.1});
     },
     "at right angles"},
    {"line-impacts", test::row_of_spheres(3, 0.1, 1), [](Scene& s) { s.bodies[1].angular_velocity.x() = 1; }, "turns"},
    {"pushed", test::pushed_box(0), [](Scene& s) { s.contact_default.friction = 0.01; }, "would slip"},
    {"pushed", test::pushed_box(0), [](Scene& s) { s.forces[0].force *= 3; }, "would roll off"},
    {"pushed", test::pushed_box(0), [](Scene& s) { s.forces[0].until = 1; }, "constant level push"},
    {"pushed", test::pushed_box(0), [](Scene& s) { s.bodies[5].position.z() += 1; }, "does not lie on"},
    {"pushed", test::pushed_box(0), [](Scene& s) { s.bodies[5].position = s.bodies[6].position; }, "could touch"},
    {"pushed", test::pushed_box(0), [](Scene& s) { s.bodies[5].position.y() += 0.011; }, "to one side of its push"},
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_scene_it_does_not_hold_for_is_refused_with_the_reason) {
  for (const Row& row : kRows) {
    Scene scene = row.scene;
    BOOST_TEST_CONTEXT(row.truth << ": " << row.says) {
      BOOST_CHECK_NO_THROW(make_truth(row.truth, scene, 2));
      row.spoil(scene);
      BOOST_CHECK_EXCEPTION(make_truth(row.truth, scene, 2), InputError, test::says(row.says));
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
