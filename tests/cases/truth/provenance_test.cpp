#include "cases/truth/provenance.h"
#include "cases/metrics/held_to_itself.h"

#include <boost/test/unit_test.hpp>

#include "adapters/engines.h"
#include "cases/metrics/metric.h"
#include "cases/truth/truth.h"
#include "core/dynamics/model/system.h"
#include "tests/cases/judged.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_provenance)

BOOST_AUTO_TEST_CASE(each_truth_says_of_what_it_is_independent) {
  for (const TruthRow& row : truths()) BOOST_TEST(provenance_of(row.name).find("independent of") != std::string::npos);
  BOOST_TEST(provenance_of("oscillator") == "a closed form, independent of every engine and method");
  BOOST_TEST(provenance_of("reference").starts_with("solved twice from equations of motion of its own"));
  BOOST_TEST(provenance_of("events").find("contact=event") != std::string::npos);
  BOOST_TEST(provenance_of("none") == "");
}

// Only runs of the code that made the truth are compared with themselves. The core's other contact methods, other
// engines, other truths, and metrics without a truth are not affected.
BOOST_AUTO_TEST_CASE(contact_by_events_is_held_to_itself_by_the_truth_events_alone) {
  const Scene scene = test::dropped_sphere(0.5);
  const auto itself = [&](const char* truth, const char* metric, const char* run) {
    return is_held_to_itself(truth, metric, parse_run_name(run, infos_of(engines())), scene);
  };
  for (const char* run : {"core:rk4,contact=event", "core:velocity-verlet,contact=event", "core,contact=event"}) {
    BOOST_TEST(itself("events", "position_error", run), run);
    BOOST_TEST(!itself("bounce", "position_error", run), run);
    BOOST_TEST(!itself("none", "position_error", run), run);
    BOOST_TEST(!itself("events", "penetration", run), run);
  }
  for (const char* run : {"core:rk4,contact=impulse", "core:rk4,contact=course", "ode", "bullet@stock"}) {
    BOOST_TEST(!itself("events", "position_error", run), run);
  }
}

// The reference of ensembles is the core with the contact that a scene gets by itself, whatever the truth.
BOOST_AUTO_TEST_CASE(the_code_that_makes_the_reference_of_ensembles_is_held_to_itself_by_them) {
  const Scene scene = test::dropped_sphere(0.5);
  for (const char* metric : {"ensemble_distance", "ensemble_p_value"}) {
    const auto itself = [&](const char* run) {
      return is_held_to_itself("none", metric, parse_run_name(run, infos_of(engines())), scene);
    };
    for (const char* run : {"core", "core:rk4", "core:rk4,contact=event"}) BOOST_TEST(itself(run), run);
    for (const char* run : {"core:rk4,contact=impulse", "ode", "bullet@stock"}) BOOST_TEST(!itself(run), run);
  }
}

// A metric that nobody has thought of is taken to need the truth.
BOOST_AUTO_TEST_CASE(what_is_measured_against_the_truth_is_known) {
  BOOST_TEST(is_against_truth("a metric of tomorrow"));
  BOOST_TEST(is_against_truth("observed_order"));
  const Scene scene = test::dropped_sphere(0.5);
  BodyTable start(scene.bodies.size());
  set_initial_state(scene, start.columns());
  const Trajectory standing{0.1, {{0, start}, {0.1, start}}};
  const auto has_no_truth = [&](const MetricRow& row) {
    return row.measure({.scene = scene, .trajectory = standing, .truth = nullptr, .leapfrog_stagger = 0})
               .not_applicable == "the case has no truth";
  };
  for (const MetricRow& row : metrics()) {
    if (has_no_truth(row)) BOOST_TEST(is_against_truth(row.name), row.name);
  }
  for (const char* own : {"creep", "energy_gain", "penetration", "restitution_error"})
    BOOST_TEST(!is_against_truth(own));
}

BOOST_AUTO_TEST_SUITE_END()
