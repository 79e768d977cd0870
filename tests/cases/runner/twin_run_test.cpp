// A run's twin, how far roundings alone may have moved it, and the truth at a run's samples.
#include "cases/runner/twin_run.h"

#include <boost/test/unit_test.hpp>

#include "cases/runner/truth_samples.h"
#include "core/scene/turned.h"
#include "tests/cases/judged.h"
#include "tests/cases/scripted_engine.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_runner_twin_run)

namespace {

// A twin whose bodies move as its script says.
EngineTable scripted(const test::Script& script) {
  EngineTable table;
  table.add(std::make_unique<test::ScriptedEngine>(script));
  return table;
}

RunName the_run() {
  RunName run;
  run.text = run.engine = "scripted";
  return run;
}

}  // namespace

BOOST_AUTO_TEST_CASE(only_a_scheme_that_is_not_the_cores_own_has_a_twin_and_only_where_nothing_can_touch) {
  const auto infos = infos_of(engines());
  const Scene free = test::fixed_spring();
  const auto twin = twin_of(engines(), parse_run_name("ode", infos), free);
  BOOST_TEST_REQUIRE(twin.has_value());
  BOOST_TEST(twin->engine == "core");
  BOOST_TEST(!twin_of(engines(), parse_run_name("core:rk4", infos), free).has_value());
  BOOST_TEST(!twin_of(engines(), parse_run_name("ode", infos), test::dropped_sphere(1)).has_value());
}

// The script does not turn with the world: its body lies in the origin, without a turn, in all four worlds; so it seems
// to be off by what the turns turn it.
BOOST_AUTO_TEST_CASE(roundings_are_the_largest_over_turned_worlds) {
  test::Script script;
  script.play = [](int, MutableBodyColumns bodies) { bodies.set_position(0, Vec3::Zero()); };
  const EngineTable table = scripted(script);
  const Scene scene = test::tumbling_body();
  Simulation run = simulate(table.find("scripted"), {}, scene, 0.5, 2);
  const TwinRun twin = run_twin(table, the_run(), scene, run, 2);
  BOOST_TEST_REQUIRE(twin.trajectory.samples.size() == 5u);
  // The rotations as in twin_run.cpp.
  double turned = 0;
  for (const Quat& q : {Quat(0.7, 0.3, -0.5, 0.4).normalized(), Quat(-0.2, 0.6, 0.5, 0.3).normalized(),
                        Quat(0.4, -0.3, 0.2, 0.8).normalized()}) {
    turned = std::max(turned, angle_between(q, Quat::Identity()));
  }
  for (int n = 0; n < 5; ++n) {
    BOOST_TEST(twin.position_rounding[n] == 0);
    BOOST_TEST(twin.orientation_rounding[n] == turned, boost::test_tools::tolerance(1e-14));
  }
  run.trajectory.samples.resize(3);
  const TwinRun shorter = run_twin(table, the_run(), scene, run, 2);
  BOOST_TEST(shorter.trajectory.samples.size() == 3u);
  BOOST_TEST(shorter.position_rounding.size() == 3u);
}

// The twin and the first turned one are stepped side by side, the others after them.
BOOST_AUTO_TEST_CASE(a_twin_ends_where_it_or_one_turned_blows_up) {
  int worlds = 0, lost_in = 0;
  test::Script script;
  script.play = [&](int step, MutableBodyColumns bodies) {
    if (step == 0) ++worlds;
    bodies.set_position(0, Vec3(worlds == lost_in && step == 3 ? std::nan("") : 0, 0, 0));
  };
  const EngineTable table = scripted(script);
  const Scene scene = test::tumbling_body();
  const Simulation run = simulate(table.find("scripted"), {}, scene, 0.5, 2);
  for (const auto& [world, samples] : {std::pair{0, 5u}, {2, 3u}, {3, 3u}, {4, 3u}}) {
    worlds = 0, lost_in = world;
    const TwinRun twin = run_twin(table, the_run(), scene, run, 2);
    BOOST_TEST(worlds == 4);
    BOOST_TEST(twin.trajectory.samples.size() == samples, world);
    BOOST_TEST(twin.position_rounding.size() == samples);
    BOOST_TEST(twin.orientation_rounding.size() == samples);
  }
}

// Kept at 0, 0.5, 1, 1.5, 2 s; asked for at those to the last bit, and of the truth itself at all others.
BOOST_AUTO_TEST_CASE(the_truth_is_asked_for_once_at_the_instants_that_all_runs_have) {
  int asked = 0;
  const test::StatedTruth truth(
      [&](double t) {
        ++asked;
        return BodyState{{t, 0, 0}, Quat::Identity(), Vec3::Zero(), Vec3::Zero()};
      },
      1.2);
  TruthOnSteps kept;
  kept.keep(truth, 0.5, 2, 1);
  kept.keep(truth, 0.5, 2, 1);
  BOOST_TEST(asked == 5);
  const auto at = [&](double dt, const std::vector<double>& times) {
    Trajectory run{dt, {}};
    for (const double t : times) run.samples.push_back({t, BodyTable(1)});
    asked = 0;
    const TruthSamples samples = kept.at_samples_of(run, truth, 1, 7);
    BOOST_TEST(samples.largest_kinetic_energy == 7);
    BOOST_TEST(samples.source == &truth);
    BOOST_TEST_REQUIRE(samples.bodies.size() == times.size());
    for (std::size_t n = 0; n < times.size(); ++n) {
      BOOST_TEST(samples.bodies[n].columns().position(0).x() == times[n]);
      BOOST_TEST(samples.error[n] == (times[n] <= 1.2 ? 0 : 1));
    }
    return asked;
  };
  BOOST_TEST(at(0.5, {0, 0.5, 1, 1.5, 2}) == 0);
  BOOST_TEST(at(0.5, {0, 0.5, 1.01, 1.5, 2, 2.5}) == 2);
  BOOST_TEST(at(0.25, {0, 0.25}) == 2);
  // A sample of a body is 136 bytes or so: a million steps are above 128 MB, and are not kept.
  asked = 0;
  kept.keep(truth, 2e-6, 2, 1);
  BOOST_TEST(asked == 0);
  // Of a thousand bodies one is 104,040 bytes: 1230 of them are not above it, and 1231 are.
  kept.keep(truth, 2.0 / 1231, 2, 1000);
  BOOST_TEST(asked == 0);
  kept.keep(truth, 2.0 / 1230, 2, 1000);
  BOOST_TEST(asked == 1231);
}

BOOST_AUTO_TEST_SUITE_END()
