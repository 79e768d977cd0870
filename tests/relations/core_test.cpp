// The core's methods under exact relations between scenes (relations.h). Every integrator runs generated scenes without
// contacts. Both methods of contact run those with contacts.
#include <boost/test/unit_test.hpp>

#include "core/world.h"
#include "tests/relations/comparison.h"
#include "tests/relations/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(relations_core)

namespace {

constexpr double kStep = 1.0 / 200;  // s
constexpr int kSteps = 100;
// m and rad. Roundings of a few metres, 1e-15 m, enlarged by up to 100 (comparison.cpp) in each of 100 steps at most.
constexpr double kRounding = 1e-10;
// Limits and motors: a flight shorter than a thousandth of the step is suppressed. In these 5 µs a body of 10 m/s²
// comes to 5e-5 m/s. A few of these leave 1e-6 m (random_mechanisms_test.cpp).
constexpr double kFlights = 2e-6;
// Gaps of joints and limits are closed to 1e-11 of a body. Where an event divides a step, velocities carry this gap
// divided by a short part of the step. 9e-10 in 1 of 200 scenes.
constexpr double kClosing = 1e-8;

constexpr const char* kWarm = "impulses of the step before are the first guess, and a run's first step has none";
constexpr const char* kWeld = "not explained: impacts of two welded halves differ from those of the whole body";
constexpr const char* kShared = "not explained: a rounding decides how an impact is shared between contact points";
constexpr const char* kFlat = "a cylinder comes to lie flat, where a rounding decides which points hold it";
constexpr const char* kNegative = "not explained: sub-steps back in time beside limits, seeds 20047 and 20053";

constexpr const char* kManyFlights = "not explained: 1.3 times what flights that are suppressed leave, seed 124";
constexpr const char* kCoarse = "not explained: a coarse step that a limit divides, seeds 143 and 153";

std::vector<test::Fact> facts_of_impulses() {
  std::vector<test::Fact> facts;
  for (const char* integrator : {"velocity-verlet", "semi-implicit-euler", "rk4"}) {
    const std::string run = std::string("core:") + integrator + ",contact=impulse";
    facts.push_back({run, "on a plane", "restarted", 3, 5, kWarm});
    facts.push_back({run, "on a plane", "welded halves", 6, 16, kWeld});
    facts.push_back({run, "in flight", "restarted", 0, 0, kWarm});
    facts.push_back({run, "in flight", "welded halves", 2, 7, kWeld});
    // One or two scenes of 40, and others for each integrator.
    for (const char* relation : {"other units", "mirrored", "turned", "moved", "boosted"})
      facts.push_back({run, "in flight", relation, 0, 2, kShared});
  }
  return facts;
}

// Rows with 0 scenes are about scenes that only other seeds have.
const std::vector<test::Fact> kFacts = {
    {"core:symplectic4", "mechanisms", "back in time", 0, 0, kNegative},
    {"core:symplectic4", "mechanisms", "other units", 0, 0, kNegative},
    {"core:symplectic4", "mechanisms", "restarted", 0, 0, kNegative},
    {"core:dormand-prince", "compound joints", "restarted", 0, 0, kManyFlights},
    {"core:rk4", "compound joints", "restarted", 0, 0, kManyFlights},
    {"core:rkmk4", "compound joints", "restarted", 0, 0, kManyFlights},
    {"core:dormand-prince,contact=event", "on a plane", "welded halves", 0, 0, kWeld},
    {"core:dormand-prince,contact=event", "in flight", "welded halves", 1, 1, kWeld},
    {"core:dormand-prince,contact=event", "line contacts", "welded halves", 1, 1, kWeld},
    {"core:dormand-prince,contact=event", "cylinders", "moved", 0, 0, kFlat},
    {"core:rk4,contact=event", "on a plane", "welded halves", 0, 0, kWeld},
    {"core:rk4,contact=event", "in flight", "welded halves", 1, 1, kWeld},
};

const std::vector<test::Fact> kCoarseFacts = {
    {"core:explicit-euler", "compound joints", "moved", 0, 0, kCoarse},
    {"core:explicit-euler", "compound joints", "restarted", 0, 0, kCoarse},
};

test::MotionSource core(const std::string& name, double rounding, double thresholds) {
  test::MotionSource run = test::run_of_engine("core:" + name, kStep, kSteps, rounding);
  run.thresholds = thresholds;
  return run;
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_integrator_keeps_relations_without_contacts) {
  for (const MethodInfo& method : core_info().methods) {
    test::check(core(method.name, kRounding, 0), "smooth", 15);  // without bits: not explained, 5e-12 m
    test::MotionSource run = core(method.name, kClosing, kFlights);
    run.keeps_bits = run.tolerance == 0;  // one of 1e-12 is in SI units
    // It closes joints by an impulse before a drift or, where that search fails, by a projection after it.
    run.has_two_ways = method.name == "semi-implicit-euler";
    test::check(run, "mechanisms", 15, kFacts);
    test::check(run, "compound joints", 20, kFacts);
  }
}

// The stages of a coarse step leave the axes of a joint apart. Rows and angles must then depend on the bodies alone. A
// velocity that carries a gap (kClosing) acts five times as long.
BOOST_AUTO_TEST_CASE(coarse_steps_keep_relations_too) {
  for (const char* method : {"core:explicit-euler", "core:rk4"}) {
    test::MotionSource run = test::run_of_engine(method, 5 * kStep, kSteps / 5, 5 * kClosing);
    run.thresholds = kFlights;
    run.keeps_bits = true;
    test::check(run, "mechanisms", 30);
    test::check(run, "compound joints", 20, kCoarseFacts);
  }
}

BOOST_AUTO_TEST_CASE(contact_by_events_keeps_relations) {
  // m and rad: what thresholds of the scene's own units decide. 1.3e-10 was the most in 400 scenes.
  constexpr double kThresholds = 1e-7;
  for (const auto& [scenes, count] : {std::pair("on a plane", 30),
                                      {"in flight", 30},
                                      {"cylinders", 20},
                                      {"line contacts", 10},
                                      {"once contradicted", test::kContradicted}})
    test::check(core("dormand-prince,contact=event", 1e-9, kThresholds), scenes, count, kFacts);
  for (const char* scenes : {"on a plane", "in flight"})
    test::check(core("rk4,contact=event", 1e-9, kThresholds), scenes, 20, kFacts);
}

BOOST_AUTO_TEST_CASE(contact_by_impulses_keeps_relations) {
  for (const char* integrator : {"velocity-verlet", "semi-implicit-euler", "rk4"}) {
    test::MotionSource run = core(std::string(integrator) + ",contact=impulse", kRounding, 0);
    run.keeps_bits = true;
    for (const char* scenes : {"on a plane", "in flight"}) test::check(run, scenes, 40, facts_of_impulses());
  }
}

// No rule says which corner of a level box comes first. The effect of one corner before the other remains: the
// tolerance of impacts (1e-3 of 4 g h = 0.05 m/s) over half a second, 3e-5 m.
BOOST_AUTO_TEST_CASE(a_level_box_lands_by_impulses_as_its_images_do) {
  test::check(core("velocity-verlet,contact=impulse", 3e-5, 0), "level box", 5);
}

BOOST_AUTO_TEST_SUITE_END()
