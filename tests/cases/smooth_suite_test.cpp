// The suite's own files: enough smooth cases, each with a source, each with the truth it asks for.
#include <boost/test/unit_test.hpp>

#include <algorithm>

#include "cases/suite.h"
#include "cases/truth/truth.h"
#include "core/scene/features.h"

using namespace rigor;

namespace {

// Nothing in it happens at an instant: neither contacts nor joints.
bool is_smooth(const Case& c) {
  const std::vector<Need> needs = needs_of(c.scene);
  return std::none_of(needs.begin(), needs.end(), [](const Need& need) {
    return need.feature.starts_with("contact:") || need.feature.starts_with("joint:");
  });
}

std::vector<Case> smooth_cases() {
  std::vector<Case> cases = select_cases({}, default_suite_dir());
  std::erase_if(cases, [](const Case& c) { return !is_smooth(c); });
  return cases;
}

}  // namespace

BOOST_AUTO_TEST_SUITE(cases_smooth_suite)

BOOST_AUTO_TEST_CASE(there_are_at_least_twenty_five_smooth_cases_each_with_a_source_and_gates) {
  const std::vector<Case> cases = smooth_cases();
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
  for (const Case& c : smooth_cases()) {
    if (c.truth == "none" || c.truth == "reference") continue;
    BOOST_TEST_CONTEXT(c.id) {
      BOOST_REQUIRE_NO_THROW(make_truth(c.truth, c.scene, c.duration));
      const auto truth = make_truth(c.truth, c.scene, c.duration);
      BodyTable start(c.scene.bodies.size());
      truth->at(0, start.columns());
      for (std::size_t i = 0; i < c.scene.bodies.size(); ++i) {
        const BodyState found = start.columns().body(i);
        const Body& body = c.scene.bodies[i];
        // The start, to the truth's own error: the closed forms compute it as they compute any other instant.
        BOOST_TEST((found.position - body.position).norm() <= truth->error(0));
        BOOST_TEST(angle_between(found.orientation, body.orientation) <= truth->error(0));
      }
    }
    ++cited;
  }
  BOOST_TEST(cited > 0);
}

BOOST_AUTO_TEST_SUITE_END()
