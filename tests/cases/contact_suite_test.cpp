// The suite's contact cases: enough of them, each with a source and gates, each with the truth it asks for; and what
// the settings of ODE's matched track are for.
#include <boost/test/unit_test.hpp>

#include <algorithm>

#include "adapters/engines.h"
#include "cases/suite.h"
#include "cases/truth/truth.h"
#include "core/engine/run_name.h"
#include "core/scene/contact_laws.h"

using namespace rigor;

namespace {

std::vector<Case> contact_cases() {
  std::vector<Case> cases = select_cases({}, default_suite_dir());
  std::erase_if(cases, [](const Case& c) { return !anything_can_touch(c.scene); });
  return cases;
}

// Steps, of the first `seconds` of a case, of which the engine says that they failed.
int complaints_of(const std::string& run_name, const std::string& id, double dt, double seconds) {
  const Case c = select_cases({id}, default_suite_dir()).at(0);
  const RunName run = parse_run_name(run_name, infos_of(engines()));
  const auto world = find_engine(engines(), run.engine).load(c.scene, run.settings);
  int complaints = 0;
  for (int n = 0; n < seconds / dt; ++n) world->step(dt), complaints += !world->complaint().empty();
  return complaints;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cases_contact_suite)

BOOST_AUTO_TEST_CASE(there_are_at_least_twenty_five_contact_cases_each_with_a_source_and_gates) {
  const std::vector<Case> cases = contact_cases();
  BOOST_TEST(cases.size() >= 25);
  for (const Case& c : cases) {
    BOOST_TEST_CONTEXT(c.id) {
      BOOST_TEST(!c.source.empty());
      BOOST_TEST(!c.gates.empty());
    }
  }
}

BOOST_AUTO_TEST_CASE(every_closed_form_that_a_case_cites_holds_for_its_scene) {
  int cited = 0;
  for (const Case& c : contact_cases()) {
    if (c.truth == "none" || c.truth == "reference") continue;
    BOOST_TEST_CONTEXT(c.id) {
      BOOST_REQUIRE_NO_THROW(make_truth(c.truth, c.scene, c.duration));
      const auto truth = make_truth(c.truth, c.scene, c.duration);
      BodyTable start(c.scene.bodies.size());
      truth->at(0, start.columns());
      for (std::size_t i = 0; i < c.scene.bodies.size(); ++i) {
        const BodyState found = start.columns().body(i);
        const Body& body = c.scene.bodies[i];
        BOOST_TEST((found.position - body.position).norm() <= truth->error(0));
        BOOST_TEST((found.velocity - body.velocity).norm() <= 1e-12 * (1 + body.velocity.norm()));
        BOOST_TEST((found.angular_velocity - body.angular_velocity).norm() <=
                   1e-12 * (1 + body.angular_velocity.norm()));
      }
      BOOST_TEST(truth->error(c.duration) < 1e-9);  // a thousandth of what metrics need of it
    }
    ++cited;
  }
  BOOST_TEST(cited >= 15);
}

BOOST_AUTO_TEST_CASE(a_little_softness_lets_the_direct_solver_of_ode_carry_a_card_house) {
  BOOST_TEST(complaints_of("ode", "contact/card-house", 1.0 / 240, 5) == 0);
  BOOST_TEST(complaints_of("ode@stock", "contact/card-house", 1.0 / 240, 5) > 0);
}

BOOST_AUTO_TEST_SUITE_END()
