// What is found of joints, as data; how it is said is tested beside the wording.
#include "cases/analysis/joint_diagnosis.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "tests/cases/report/jointed_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_joint_diagnosis)

BOOST_AUTO_TEST_CASE(rows_and_masses_of_a_mechanism) {
  const Scene chain = test::chain_of(5, 30);
  BOOST_TEST(joints_in_a_row(chain) == 5);
  BOOST_TEST(mass_ratio(chain) == 30);
  BOOST_TEST(joint_size(chain) == 0.5, boost::test_tools::tolerance(1e-15));
  Scene free = chain;
  free.joints.erase(free.joints.begin());
  BOOST_TEST(joints_in_a_row(free) == 4);
  Scene loop = chain;  // closed to the world: no way to a body is longer than three joints
  loop.joints.push_back({.a = kWorld, .b = 4, .type = BallJoint{{5, 0, 0}}});
  BOOST_TEST(joints_in_a_row(loop) == 3);
  Scene sliding = test::chain_of(1, 1);  // it is held at its centre: what else it reaches is how it is spread
  sliding.joints[0].type = SliderJoint{Vec3::UnitX()};
  BOOST_TEST(joint_size(sliding) == std::sqrt(0.3 / 2), boost::test_tools::tolerance(1e-15));
  BOOST_TEST(joints_in_a_row(Scene()) == 0);
  BOOST_TEST(mass_ratio(Scene()) == 1);
}

BOOST_AUTO_TEST_CASE(joints_that_part_are_found_with_the_engines_own_share) {
  Results grid = test::jointed_results(test::chain_of(2, 1));
  test::set_gaps(grid, 0, {0.01, 0.0025});
  BOOST_TEST(joint_diagnoses(grid, grid.cases[0]).empty());  // no setting tells why
  test::set_setting(grid, 0, "erp", "0.2");
  const auto found = joint_diagnoses(grid, grid.cases[0]);
  BOOST_TEST_REQUIRE(found.size() == 1u);
  BOOST_TEST(found[0].topic == kJointsPart);
  BOOST_TEST(found[0].value == 0.01);
  BOOST_TEST(found[0].over.size() == 2u);
  BOOST_TEST(found[0].cause == "Its setting \"erp\": 0.2.");
  test::set_gaps(grid, 0, {1e-6, 1e-7});  // too little to say
  BOOST_TEST(joint_diagnoses(grid, grid.cases[0]).empty());
}

// Too few sweeps show only beside another run of the engine whose joints hold.
BOOST_AUTO_TEST_CASE(a_chain_stretches_beside_a_run_whose_joints_hold) {
  Results grid = test::jointed_results(test::chain_of(8, 1));
  test::set_gaps(grid, 0, {0.3, 0.2}), test::set_setting(grid, 0, "iterations", "20");
  BOOST_TEST(joint_diagnoses(grid, grid.cases[0]).empty());
  test::set_gaps(grid, 1, {0.02, 0.01});
  BOOST_TEST(joint_diagnoses(grid, grid.cases[0]).empty());  // it holds, but is another engine's
  grid.runs[1].engine = grid.runs[0].engine;
  const auto found = joint_diagnoses(grid, grid.cases[0]);
  BOOST_TEST_REQUIRE(found.size() == 1u);
  BOOST_TEST(found[0].topic == kChainStretches);
  BOOST_TEST((found[0].runs == std::vector<std::size_t>{0, 1}));
  BOOST_TEST(found[0].value == 0.3);
  BOOST_TEST(found[0].beside == 0.02);
  test::set_gaps(grid, 1, {0.1, 0.1});  // no better by enough
  BOOST_TEST(joint_diagnoses(grid, grid.cases[0]).empty());
  grid.cases[0].definition.scene = test::chain_of(2, 1), test::set_gaps(grid, 1, {0.02, 0.01});
  BOOST_TEST(joint_diagnoses(grid, grid.cases[0]).empty());  // no chain
}

BOOST_AUTO_TEST_CASE(only_a_loss_of_first_order_is_the_joints) {
  Results grid = test::jointed_results(test::chain_of(2, 1));
  test::set_setting(grid, 0, "erp", "0.2");
  const auto topics = [&](double coarse, double fine, double sign) {
    test::set_metric(grid, 0, "energy_drift_synchronised", {coarse, fine}, {1, kWorld, "energy", 5 + sign, 5});
    std::vector<std::string> names;
    for (const Diagnosis& one : joint_diagnoses(grid, grid.cases[0])) names.push_back(one.topic);
    return names;
  };
  const double ratio = test::coarse_over_fine(grid);
  BOOST_TEST((topics(0.2, 0.2 / ratio, -1) == std::vector<std::string>{kJointsTakeEnergy}));
  BOOST_TEST(topics(0.2, 0.2 / ratio, 1).empty());           // a gain
  BOOST_TEST(topics(0.2, 0.2 / ratio / ratio, -1).empty());  // second order: an error of position
  BOOST_TEST(topics(0.2, 0.2, -1).empty());                  // no order at all
  BOOST_TEST(topics(0.001, 0.001 / ratio, -1).empty());      // too little
  grid.cases[0].definition.scene.joints[0].damping = 1;      // it should lose some
  grid.cases[0].definition.scene.joints[0].type = HingeJoint{{0, 0, 0}, Vec3::UnitZ()};
  BOOST_TEST(topics(0.2, 0.2 / ratio, -1).empty());
}

BOOST_AUTO_TEST_SUITE_END()
