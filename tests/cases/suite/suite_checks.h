// Checks that hold for each family of the suite.
#pragma once

#include <boost/test/unit_test.hpp>
#include <functional>

#include "cases/case/suite.h"
#include "cases/truth/truth.h"
#include "tests/cases/vocabulary.h"

namespace rigor::test {

inline std::vector<Case> suite_cases(const std::function<bool(const Case&)>& is_one) {
  std::vector<Case> cases = select_cases({}, default_suite_dir(), test::words());
  std::erase_if(cases, [&](const Case& c) { return !is_one(c); });
  return cases;
}

inline void check_sources_and_gates(const std::vector<Case>& cases) {
  BOOST_TEST_REQUIRE(!cases.empty());
  for (const Case& c : cases) {
    BOOST_TEST_CONTEXT(c.id) {
      BOOST_TEST(!c.source.empty());
      BOOST_TEST(!c.gates.empty());
    }
  }
}

// Each cited closed form can be constructed. It begins at the scene's state, to its own error there (computed as at any
// instant), with velocities to rounding. It ends with an error of at most `at_the_end`.
inline void check_closed_forms(const std::vector<Case>& cases, double at_the_end) {
  int cited = 0;
  for (const Case& c : cases) {
    if (c.truth == "none" || c.truth == "recording" || c.truth == "reference" || c.truth == "events") continue;
    BOOST_TEST_CONTEXT(c.id) {
      BOOST_REQUIRE_NO_THROW(make_truth(c.truth, c.scene, c.duration));
      const auto truth = make_truth(c.truth, c.scene, c.duration);
      BodyTable start(c.scene.bodies.size());
      truth->at(0, start.columns());
      for (std::size_t i = 0; i < c.scene.bodies.size(); ++i) {
        const BodyState found = start.columns().body(i);
        const Body& body = c.scene.bodies[i];
        BOOST_TEST((found.position - body.position).norm() <= truth->error(0));
        BOOST_TEST(angle_between(found.orientation, body.orientation) <= truth->error(0));
        BOOST_TEST((found.velocity - body.velocity).norm() <= 1e-12 * (1 + body.velocity.norm()));
        BOOST_TEST((found.angular_velocity - body.angular_velocity).norm() <=
                   1e-12 * (1 + body.angular_velocity.norm()));
      }
      BOOST_TEST(truth->error(c.duration) < at_the_end);
    }
    ++cited;
  }
  BOOST_TEST(cited > 0);
}

}  // namespace rigor::test
