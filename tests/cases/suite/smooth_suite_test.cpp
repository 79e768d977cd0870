// The suite's smooth cases: each with a source, each with the truth it asks for.
#include <boost/test/unit_test.hpp>

#include <algorithm>

#include "core/scene/features/features.h"
#include "tests/cases/suite/suite_checks.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_suite_smooth_suite)

namespace {

// Nothing in it happens at an instant: neither contacts nor joints.
bool is_smooth(const Case& c) {
  const std::vector<Need> needs = needs_of(c.scene);
  return std::none_of(needs.begin(), needs.end(),
                      [](const Need& need) { return is_contact(need.feature) || is_joint(need.feature); });
}

std::vector<Case> smooth_cases() { return test::suite_cases(is_smooth); }

}  // namespace

BOOST_AUTO_TEST_CASE(each_smooth_case_has_a_source_and_gates) { test::check_sources_and_gates(smooth_cases()); }

BOOST_AUTO_TEST_CASE(every_closed_form_that_a_case_cites_holds_for_its_scene) {
  test::check_closed_forms(smooth_cases(), 1e-9);  // near a separatrix; a thousandth of what metrics need of it
}

BOOST_AUTO_TEST_SUITE_END()
