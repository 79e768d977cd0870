// Cells have contact forces where a gate names one of their metrics, and in cases without gates.
#include <boost/test/unit_test.hpp>

#include "adapters/engines.h"
#include "cases/runner/grid.h"
#include "core/engine/run_name.h"
#include "tests/cases/limit_as.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_contact_records)

namespace {

constexpr double kWeight = 2 * 9.81;  // N

Case ball_on_ground() {
  Case definition;
  definition.id = "ball", definition.title = "A ball on the ground";
  Body ball, ground;
  ball.name = "ball", ball.shape = Sphere{0.1}, ball.collides = true, ball.position = Vec3(0, 0, 0.1);
  ball.mass = 2, ball.inertia = 0.008 * Mat3::Identity();
  ground.name = "ground", ground.fixed = true, ground.shape = Plane{Vec3::UnitZ(), 0}, ground.collides = true;
  definition.scene.bodies = {ball, ground};
  definition.scene.gravity = {0, 0, -9.81};
  definition.scene.contact_default = {0, 0.5};
  definition.duration = 0.5, definition.dt = {{0.01, "1/100"}};
  return definition;
}

Case with_gate_on(Case definition, const std::string& metric) {
  Gate gate;
  gate.metric = metric, test::limit_as<BoundLimit>(gate).max = 1;
  definition.gates = {gate};
  return definition;
}

MetricValue balance_in(const Case& definition) {
  const EngineTable& table = engines();
  Results grid = plan_grid({definition}, {parse_run_name("ode", table.infos())}, table, {false});
  run_grid(grid, table, {}, [](std::size_t, std::size_t) {});
  const Cell& cell = grid.cases[0].cells.at(0);
  BOOST_TEST_REQUIRE(cell.metrics.count("contact_balance") == 1u, cell.reason);
  return cell.metrics.at("contact_balance");
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_case_without_gates_has_contact_forces) {
  const MetricValue balance = balance_in(ball_on_ground());
  BOOST_TEST(balance.not_applicable == "");
  BOOST_TEST(balance.value < 1e-9 * kWeight);
}

BOOST_AUTO_TEST_CASE(a_case_with_gates_has_them_where_one_of_the_gates_names_them) {
  BOOST_TEST(balance_in(with_gate_on(ball_on_ground(), "force_peak")).not_applicable == "");
  BOOST_TEST(balance_in(with_gate_on(ball_on_ground(), "penetration")).not_applicable ==
             "contact forces are recorded where a gate of the case names them");
}

// 50 bodies take up to 5000 steps.
BOOST_AUTO_TEST_CASE(a_case_of_many_bodies_and_steps_without_gates_has_none) {
  Case definition = ball_on_ground();
  for (int n = 1; n < 49; ++n) {
    definition.scene.bodies.push_back(definition.scene.bodies[0]);
    definition.scene.bodies.back().name = "ball " + std::to_string(n);
    definition.scene.bodies.back().position.x() = n;
  }
  definition.duration = 5001 * 0.01;
  BOOST_TEST(balance_in(definition).not_applicable ==
             "contact forces are recorded where a gate of the case names them");
  definition.duration = 4999 * 0.01;
  BOOST_TEST(balance_in(definition).not_applicable !=
             "contact forces are recorded where a gate of the case names them");
}

BOOST_AUTO_TEST_SUITE_END()
