// The suite's contact cases: each with a source and gates, each with the truth it asks for; and what
// the settings of ODE's matched track are for.
#include <boost/test/unit_test.hpp>

#include <algorithm>

#include "adapters/engines.h"
#include "core/engine/run_name.h"
#include "core/scene/contact_laws.h"
#include "tests/cases/suite/suite_checks.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_suite_contact_suite)

namespace {

std::vector<Case> contact_cases() {
  return test::suite_cases([](const Case& c) { return anything_can_touch(c.scene); });
}

// Steps, of the first `seconds` of a case, of which the engine says that they failed.
int solver_warnings_of(const std::string& run_name, const std::string& id, double dt, double seconds) {
  const Case c = select_cases({id}, default_suite_dir(), test::words()).at(0);
  const RunName run = parse_run_name(run_name, infos_of(engines()));
  const auto world = find_engine(engines(), run.engine).load(c.scene, run.settings);
  int solver_warnings = 0;
  for (int n = 0; n < seconds / dt; ++n) world->step(dt), solver_warnings += !world->solver_warning().empty();
  return solver_warnings;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_contact_case_has_a_source_and_gates) { test::check_sources_and_gates(contact_cases()); }

BOOST_AUTO_TEST_CASE(every_closed_form_that_a_case_cites_holds_for_its_scene) {
  test::check_closed_forms(contact_cases(), 1e-9);  // a thousandth of what metrics need of it
}

BOOST_AUTO_TEST_CASE(a_little_softness_lets_the_direct_solver_of_ode_carry_a_card_house) {
  BOOST_TEST(solver_warnings_of("ode", "contact/card-house", 1.0 / 240, 5) == 0);
  BOOST_TEST(solver_warnings_of("ode@stock", "contact/card-house", 1.0 / 240, 5) > 0);
}

BOOST_AUTO_TEST_SUITE_END()
