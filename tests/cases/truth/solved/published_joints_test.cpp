// The reference of a cylindrical joint against tables that MSC ADAMS computed: Project Chrono, data/testing/joints/
// ADAMS, Cylindrical_Case01 and Cylindrical_Case02, BSD 3-Clause. A body of 1 kg on a line through the origin, two
// metres off it, gravity 9.80665 m/s² along -z. In case 1 the line is z and the body falls along it; in case 2 the
// line is y and the body swings about it.
#include <algorithm>
#include <boost/test/unit_test.hpp>

#include "cases/truth/truth.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_solved_published_joints)

namespace {

Scene on_line(const Vec3& axis) {
  Scene scene;
  scene.gravity = {0, 0, -9.80665};
  scene.bodies = {test::body("rod", 1, {0.04, 0.1, 0.1}, {2, 0, 0})};
  scene.joints = {{.a = kWorld, .b = 0, .type = CylindricalJoint{{0, 0, 0}, axis}}};
  return scene;
}

struct TabledState {
  double time;    // s
  Vec3 position;  // m
  Vec3 velocity;  // m/s
  double w_y;     // rad/s
};

// The table has six digits of each number.
void check_meets(const Scene& scene, const std::vector<TabledState>& table) {
  const auto truth = make_truth("reference", scene, table.back().time);
  BodyTable found(1);
  for (const TabledState& row : table) {
    truth->at(row.time, found.columns());
    const BodyState body = found.columns().body(0);
    const double within = 5e-6 * std::max({1.0, row.position.norm(), row.velocity.norm()});
    BOOST_TEST_CONTEXT("t = " << row.time << " s") {
      BOOST_TEST(truth->error(row.time) < 1e-9);
      BOOST_TEST((body.position - row.position).norm() < within);
      BOOST_TEST((body.velocity - row.velocity).norm() < within);
      BOOST_TEST((body.angular_velocity - Vec3(0, row.w_y, 0)).norm() < within);
    }
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_body_falls_along_a_vertical_cylindrical_joint_as_adams_has_it) {
  check_meets(on_line(Vec3::UnitZ()), {{0.5, {2, 0, -1.22583}, {0, 0, -4.90333}, 0},
                                       {1, {2, 0, -4.90332}, {0, 0, -9.80665}, 0},
                                       {2, {2, 0, -19.6133}, {0, 0, -19.6133}, 0},
                                       {5, {2, 0, -122.583}, {0, 0, -49.0333}, 0}});
}

BOOST_AUTO_TEST_CASE(a_body_swings_about_a_level_cylindrical_joint_as_adams_has_it) {
  check_meets(on_line(Vec3::UnitY()), {{0.5, {1.66081, 0, -1.11432}, {-2.57277, 0, -3.8345}, 2.30881},
                                       {1, {-0.892381, 0, -1.78988}, {-5.23742, 0, 2.61123}, 2.92614},
                                       {2, {-1.95112, 0, -0.439479}, {0.637222, 0, -2.82902}, -1.44995},
                                       {3, {1.86917, 0, -0.711481}, {1.31259, 0, 3.44837}, -1.84487},
                                       {5, {-1.99968, 0, -0.0355587}, {-0.0146657, 0, 0.824742}, 0.412436}});
}

BOOST_AUTO_TEST_SUITE_END()
