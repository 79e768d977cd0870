// The suite's cases with joints: each with a source, each with the truth it asks for.
#include <boost/test/unit_test.hpp>

#include "tests/cases/suite/suite_checks.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_suite_joint_suite)

namespace {

std::vector<Case> jointed_cases() {
  return test::suite_cases([](const Case& c) { return !c.scene.joints.empty(); });
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_jointed_case_has_a_source_and_gates) { test::check_sources_and_gates(jointed_cases()); }

BOOST_AUTO_TEST_CASE(every_closed_form_that_a_case_cites_holds_for_its_scene) {
  test::check_closed_forms(jointed_cases(), 1e-11);  // a hundred-thousandth of what metrics need of it
}

BOOST_AUTO_TEST_SUITE_END()
