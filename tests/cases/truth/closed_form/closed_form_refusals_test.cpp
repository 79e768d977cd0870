// Each closed form says what the scene would have to be.
#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "tests/cases/truth/closed_form/smooth/smooth_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_closed_form_refusals)

namespace {

struct Row {
  const char* truth;
  Scene scene;
  void (*spoil)(Scene&);
  const char* says;
};

const Row kRows[] = {
    {"asymmetric-top", test::free_body(Vec3(1, 2, 3), {1, 2, 3}),
     [](Scene& s) { s.bodies[0].inertia = Vec3(1, 2, 2).asDiagonal(); }, "take 'axisymmetric-top'"},
    {"asymmetric-top", test::free_body(Vec3(1, 2, 3), {1, 2, 3}),
     [](Scene& s) { s.bodies[0].angular_velocity.setZero(); }, "'top' does not turn"},
    {"axisymmetric-top", test::free_body(Vec3(1, 1, 3), {1, 2, 3}), [](Scene& s) { s.bodies[0].inertia(0, 0) = 1.1; },
     "1, 1.1000000000000001 and 3 kg m²"},
    {"oscillator", test::oscillator(1), [](Scene& s) { s.bodies.push_back(s.bodies[0]); }, "'mass' moves as well"},
    {"oscillator", test::oscillator(1), [](Scene& s) { s.bodies[0].fixed = true; }, "no body moves"},
    {"oscillator", test::oscillator(1), [](Scene& s) { s.springs.push_back(s.springs[0]); }, "there are 2 springs"},
    {"oscillator", test::oscillator(1), [](Scene& s) { s.springs[0].a = 0; }, "what stands still"},
    {"oscillator", test::oscillator(1),
     [](Scene& s) {
       s.springs[0].point_b = {0, 0.1, 0};
     },
     "at (0, 0.1, 0)"},
    {"oscillator", test::oscillator(1), [](Scene& s) { s.springs[0].stiffness = 0; }, "no stiffness"},
    {"oscillator", test::oscillator(1),
     [](Scene& s) {
       s.bodies[0].velocity = {1, 0.1, 0};
     },
     "its velocity"},
    {"oscillator", test::oscillator(1),
     [](Scene& s) {
       s.gravity = {0, 0, -9.8};
     },
     "gravity is not along"},
    {"oscillator", test::oscillator(1),
     [](Scene& s) {
       s.bodies[0].velocity = {-20, 0, 0};
     },
     "the force jumps"},
    {"oscillator", test::oscillator(1),
     [](Scene& s) {
       s.bodies[0].angular_velocity = {1, 2, 3};
     },
     "would tumble"},
    {"principal-torque", test::torqued(),
     [](Scene& s) {
       s.forces[0].force = {1, 0, 0};
     },
     "has a force as well"},
    {"principal-torque", test::torqued(),
     [](Scene& s) {
       s.forces[0].torque = {1, 0, 0};
     },
     "across it"},
    {"principal-torque", test::torqued(), [](Scene& s) { s.bodies[0].inertia(0, 2) = s.bodies[0].inertia(2, 0) = 0.1; },
     "turns about another axis"},
    {"projectile", test::torqued(),
     [](Scene& s) {
       s.forces.clear(), s.bodies[0].angular_velocity = {1, 2, 3};
     },
     "'top' would tumble"},
};

}  // namespace

BOOST_AUTO_TEST_CASE(a_scene_it_does_not_hold_for_is_refused_with_the_reason) {
  for (const Row& row : kRows) {
    Scene scene = row.scene;
    scene.springs.reserve(4);
    BOOST_CHECK_NO_THROW(make_truth(row.truth == std::string("projectile") ? "principal-torque" : row.truth, scene, 1));
    row.spoil(scene);
    BOOST_TEST_CONTEXT(row.truth << ": " << row.says)
    BOOST_CHECK_EXCEPTION(make_truth(row.truth, scene, 1), InputError, test::says(row.says));
  }
}

BOOST_AUTO_TEST_SUITE_END()
