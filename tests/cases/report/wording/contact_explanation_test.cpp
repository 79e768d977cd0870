// What is said of contacts that come out wrong, and that nothing is said of those that do not.
#include "cases/report/wording/explanations/contact_explanation.h"

#include <boost/test/unit_test.hpp>

#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_contact_explanation)

namespace {

// The sample's first run at two steps, with these values of a metric at the coarser and the finer one.
Results with(const std::string& metric, double coarse, double fine, const Instant& worst) {
  Results grid = sample_results();
  CaseResult& result = grid.cases.front();
  BOOST_REQUIRE(result.cells[0].dt.seconds != result.cells[1].dt.seconds);
  const bool first_is_coarse = result.cells[0].dt.seconds > result.cells[1].dt.seconds;
  for (int i = 0; i < 2; ++i) {
    result.cells[i].metrics[metric] = sample_metric((i == 0) == first_is_coarse ? coarse : fine, worst);
    result.cells[i].settings = {{"erp", "0.2 of it"}, {"friction", "a pyramid"}, {"restitution", "across a gap"}};
  }
  return grid;
}

std::vector<std::string> said_of(const Results& grid) {
  std::vector<std::string> said;
  for (const Message& message : contact_explanations(grid, grid.cases.front())) said.push_back(message.text);
  return said;
}

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

BOOST_AUTO_TEST_CASE(restitution_that_gets_worse_with_dt_does_not_converge) {
  const Instant bounce{0.5, 0, "restitution", 0.5, 1};
  const auto said = said_of(with("restitution_error", 0.05, 0.5, bounce));
  BOOST_REQUIRE(said.size() == 1);
  BOOST_TEST(has(said[0], "does not fall with dt"));
  BOOST_TEST(has(said[0], "0.05 at dt = 1/10 s, 0.5 at 1/20 s"));
  BOOST_TEST(has(said[0], "across a gap"));
  BOOST_TEST(said_of(with("restitution_error", 0.5, 0.05, bounce)).empty());    // it does
  BOOST_TEST(said_of(with("restitution_error", 0.001, 0.01, bounce)).empty());  // too little to say
}

BOOST_AUTO_TEST_CASE(bodies_that_part_after_a_dead_impact_have_been_pushed) {
  const Instant pop{0.5, 0, "restitution", 0.14, 0};
  const auto said = said_of(with("restitution_error", 0.01, 0.14, pop));
  BOOST_REQUIRE(said.size() == 1);
  BOOST_TEST(has(said[0], "part at 14 % of their approach speed, at dt = "));
  BOOST_TEST(has(said[0], "0.2 of it"));
  BOOST_TEST(!has(said[0], "does not fall"));
  const Instant through{0.5, 0, "restitution", 1, 0};  // it was not stopped at all: that is no pop
  for (const std::string& sentence : said_of(with("restitution_error", 1, 1, through)))
    BOOST_TEST(!has(sentence, "as speed"));
}

BOOST_AUTO_TEST_CASE(a_spread_over_directions_is_told_with_the_worst_way) {
  const Instant short_one{2, 0, "distance", 1.8, 2.548};
  const auto said = said_of(with("friction_anisotropy", 0.293, 0.293, short_one));
  BOOST_REQUIRE(said.size() == 1);
  BOOST_TEST(has(said[0], "stops after 1.8 m instead of 2.5 m"));
  BOOST_TEST(has(said[0], "a pyramid"));
  BOOST_TEST(said_of(with("friction_anisotropy", 0.3, 0.001, short_one)).empty());
}

BOOST_AUTO_TEST_CASE(forces_that_grow_as_dt_falls_are_spikes) {
  const Instant spike{0.1, 0, "force", 90, 10};
  const auto said = said_of(with("force_peak", 1.2, 9, spike));
  BOOST_REQUIRE(said.size() == 1);
  BOOST_TEST(has(said[0], "grows as dt falls"));
  BOOST_TEST(has(said[0], "1.2 at dt = 1/10 s, 9 at 1/20 s"));
  BOOST_TEST(has(said[0], "At dt = 1/20 s it is 90 N in place of 10 N"));
  BOOST_TEST(!has(said[0], "Its impulse hardly depends on dt"));  // 0.02 and 0.4 of the force at rest times a second
  BOOST_TEST(has(said[0], "0.2 of it"));
  const auto recovery = said_of(with("force_peak", 5, 9, spike));  // 0.4 at both steps
  BOOST_REQUIRE(recovery.size() == 1);
  BOOST_TEST(has(recovery[0], "Its impulse hardly depends on dt"));
  BOOST_TEST(has(recovery[0], "Correct less of an overlap in a step"));
  BOOST_TEST(said_of(with("force_peak", 9, 1.2, spike)).empty());    // it falls
  BOOST_TEST(said_of(with("force_peak", 1.2, 1.9, spike)).empty());  // too little to say
  BOOST_TEST(said_of(with("force_peak", 8, 9, spike)).empty());      // it does not grow with 1/dt
}

BOOST_AUTO_TEST_CASE(a_body_that_moves_on_to_the_end_creeps) {
  const auto said_with = [](double coarse, double fine, double share_of_run) {
    Results grid = with("creep", coarse, fine, {});
    CaseResult& result = grid.cases.front();
    result.definition.scene.bodies.front().shape = Sphere{0.5};
    const Instant last{share_of_run * result.definition.duration, 0, "displacement", fine, 0};
    for (int i = 0; i < 2; ++i) result.cells[i].metrics["creep"].worst = last;
    return said_of(grid);
  };
  const auto said = said_with(0.02, 0.01, 1);
  BOOST_REQUIRE(said.size() == 1);
  BOOST_TEST(has(said[0], "10 mm from its place, at dt = 1/20 s"), said[0]);
  BOOST_TEST(has(said[0], "Make friction stiffer"));
  BOOST_TEST(said_with(0.02, 1e-4, 1).empty());    // too little, at the finest step
  BOOST_TEST(said_with(0.02, 0.01, 0.5).empty());  // it has settled
}

BOOST_AUTO_TEST_CASE(a_gap_under_load_that_falls_with_dt_is_told) {
  const auto said_with = [](double coarse, double fine, double restitution) {
    Results grid = with("hover", coarse, fine, {});
    Scene& scene = grid.cases.front().definition.scene;
    for (Body& body : scene.bodies) body.shape = Sphere{0.5};
    scene.contact_default.restitution = restitution;
    return said_of(grid);
  };
  const auto said = said_with(0.02, 0.002, 0);
  BOOST_REQUIRE(said.size() == 1);
  BOOST_TEST(has(said[0], "The mean gap under load: 20 mm at dt = 1/10 s, 2 mm at 1/20 s"), said[0]);
  BOOST_TEST(has(said[0], "Take a smaller step"));
  BOOST_TEST(said_with(0.004, 0.0004, 0).empty());  // too little
  BOOST_TEST(said_with(0.02, 0.019, 0).empty());    // it does not fall
  BOOST_TEST(said_with(0.02, 0.002, 0.5).empty());  // a bounce leaves a gap
}

// Of 9.81 N of weight.
BOOST_AUTO_TEST_CASE(forces_that_do_not_explain_the_motion_are_told) {
  const auto said_with = [](double coarse, double fine, double gravity) {
    Results grid = with("contact_balance", coarse, fine, {});
    Scene& scene = grid.cases.front().definition.scene;
    scene.gravity = {0, 0, -gravity};
    for (Body& body : scene.bodies) body.mass = 1;
    return said_of(grid);
  };
  const auto said = said_with(0.9, 1.2, 9.81);
  BOOST_REQUIRE(said.size() == 1);
  BOOST_TEST(has(said[0], "They leave 1.2 N unexplained at dt = 1/20 s"), said[0]);
  BOOST_TEST(said_with(0.09, 1.2, 9.81).empty());  // explained at the coarse step
  BOOST_TEST(said_with(0.9, 0.09, 9.81).empty());  // and at the fine one
  BOOST_TEST(said_with(0.9, 1.2, 0).empty());      // no weight to compare with
}

BOOST_AUTO_TEST_CASE(nothing_is_said_where_nothing_was_measured) { BOOST_TEST(said_of(sample_results()).empty()); }

BOOST_AUTO_TEST_SUITE_END()
