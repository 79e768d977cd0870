#include "cases/gates/quick.h"

#include <boost/test/unit_test.hpp>

#include "core/base/error.h"
#include "tests/cases/limit_as.h"
#include "tests/cases/runner/faulty_engine.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_gates_quick)

namespace {

// Ten seconds of one body: quick at 1/10 and no longer so at a thousandth of what is allowed.
Case long_case() {
  Case definition = drifting_body("long");
  definition.duration = 10;
  definition.dt = {{0.1, "1/10"}, {10 / (1000 * kQuickBodySteps), "tiny"}};
  return definition;
}

Gate gate(const std::string& metric) {
  Gate out;
  out.metric = metric;
  return out;
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_gate_keeps_its_quick_steps_and_an_order_needs_all_of_them) {
  Case definition = long_case();
  Gate limit = gate("position_error"), order = gate("position_error"), fine = gate("energy_drift");
  test::limit_as<OrderLimit>(order).at_least = 1, fine.dt = {definition.dt[1]};
  definition.gates = {limit, order, fine};
  const auto selected = quick_selection({definition}, {});
  BOOST_TEST_REQUIRE(selected.size() == 1u);
  BOOST_TEST_REQUIRE(selected[0].gates.size() == 1u);
  BOOST_TEST_REQUIRE(selected[0].gates[0].dt.size() == 1u);
  BOOST_TEST(selected[0].gates[0].dt[0].text == "1/10");
  definition.dt.pop_back();
  definition.gates.pop_back();
  BOOST_TEST(quick_selection({definition}, {})[0].gates.size() == 2u);
}

BOOST_AUTO_TEST_CASE(a_case_without_quick_gates_goes_and_none_at_all_is_refused) {
  Case slow = long_case(), quick = long_case();
  Gate fine = gate("position_error");
  fine.dt = {slow.dt[1]};
  slow.gates = {fine}, quick.gates = {gate("position_error")};
  BOOST_TEST(quick_selection({slow, quick}, {}).size() == 1u);
  BOOST_CHECK_THROW(quick_selection({slow}, {}), InputError);
}

BOOST_AUTO_TEST_CASE(what_is_quick_counts_bodies_by_steps) {
  for (const auto& [share, is_quick] : {std::pair(1.0, true), std::pair(1.001, false)}) {
    Case definition = long_case();
    definition.scene.bodies.resize(4, definition.scene.bodies.front());
    definition.dt = {{4 * definition.duration / (share * kQuickBodySteps), "step"}, {1, "1"}};
    definition.gates = {gate("position_error")};
    BOOST_TEST(quick_selection({definition}, {})[0].gates[0].dt.size() == (is_quick ? 2u : 1u), share);
  }
}

BOOST_AUTO_TEST_CASE(an_observed_order_needs_all_of_its_steps_too) {
  Case definition = long_case();
  definition.gates = {gate("observed_order"), gate("position_error")};
  const auto selected = quick_selection({definition}, {});
  BOOST_TEST_REQUIRE(selected[0].gates.size() == 1u);
  BOOST_TEST(selected[0].gates[0].metric == "position_error");
}

BOOST_AUTO_TEST_SUITE_END()
