// Conservation laws as evidence: which ones hold in a scene, and how a mistake that vanishes with dt breaks them.
#include "cases/analysis/mistakes/laws.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

#include "adapters/faults/broken_engine.h"
#include "adapters/faults/faults.h"
#include "adapters/plugin/plugins.h"
#include "cases/analysis/mistakes/finder.h"
#include "cases/report/wording/mistakes.h"
#include "generated/tests/places.h"
#include "tests/cases/vocabulary.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_laws)

namespace {

ProbeScene probe(const std::string& id) {
  return probes_of(select_cases({id}, default_suite_dir(), test::words())).front();
}

const Fault& fault_called(const std::string& name) {
  for (const Fault& fault : faults()) {
    if (fault.name == name) return fault;
  }
  throw std::logic_error(name);
}

// toy.py steps angular momentum itself, and has no twin.
struct Toy {
  Toy() : table(built_in_engines()) {
    add_plugin(table, "python3 " RIGOR_SOURCE_DIR "/adapters/plugin/examples/toy.py", 20);
  }
  MistakeReport report(const Fault& fault) {
    MistakeFinder finder(
        table, parse_run_name("toy-py", table.infos()),
        probes_of(select_cases({"tops/dzhanibekov-box", "tops/asymmetric-top"}, default_suite_dir(), test::words())),
        {2, 10});
    return finder.report(BrokenEngine(table.find("toy-py"), fault));
  }
  EngineTable table;
};

const LawDrift& law_of(const MistakeReport& report, const std::string& law) {
  for (const LawDrift& drift : report.laws) {
    if (drift.law == law) return drift;
  }
  throw std::logic_error("no law " + law);
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_law_is_asked_where_it_holds_alone) {
  using Laws = std::vector<std::string>;
  BOOST_TEST((laws_of(*probe("tops/dzhanibekov-box").scene) == Laws{"linear momentum", "angular momentum"}));
  BOOST_TEST((laws_of(*probe("springs/two-bodies").scene) == Laws{"linear momentum"}));
  BOOST_TEST(laws_of(*probe("springs/fixed-spring").scene).empty());
  BOOST_TEST(laws_of(*probe("contact/collision").scene).empty());
  BOOST_TEST(laws_of(*probe("forces/torqued-top").scene).empty());
  BOOST_TEST(laws_of(*probe("joints/pendulum-90").scene).empty());
}

// One body of 2 kg and unit inertia, at rest and then at 1 m/s along x, under gravity of -1 m/s² along x: P - t M g
// changes by 2 (1 + 1 × 0.5) = 3 kg m/s, of the 2 kg m/s that it carries.
BOOST_AUTO_TEST_CASE(a_drift_is_a_share_of_the_momentum_in_the_motion) {
  Scene scene;
  scene.gravity = {-1, 0, 0};
  scene.bodies = {Body{}};
  scene.bodies[0].mass = 2, scene.bodies[0].inertia = Mat3::Identity();
  ProbeScene one{"one", std::make_shared<Scene>(scene)};
  one.dt = 0.5;
  const auto sample = [](double speed, double spin) {
    std::vector<double> row(kMotionColumns, 0.0);
    row[3] = row[7] = row[11] = 1, row[12] = speed, row[17] = spin;
    return row;
  };
  StateSeries motion{sample(0, 4), ""};
  const std::vector<double> later = sample(1, 5);
  motion.states.insert(motion.states.end(), later.begin(), later.end());
  LawWatch watch(false);
  watch.add(one, motion, motion);
  watch.add(one, {{}, "it did not run"}, motion);
  BOOST_TEST_REQUIRE(watch.drifts().size() == 2u);
  const LawDrift angular = watch.drifts()[0], linear = watch.drifts()[1];
  BOOST_TEST(angular.law == "angular momentum");
  BOOST_TEST(std::abs(angular.drift - 0.2) < 1e-15);
  BOOST_TEST(std::abs(linear.drift - 1.5) < 1e-15);
  BOOST_TEST(linear.cases == 1u);
  BOOST_TEST(!linear.is_kept);
}

BOOST_AUTO_TEST_CASE(an_inertia_of_the_step_before_shows_in_the_angular_momentum) {
  Toy toy;
  const MistakeReport whole = toy.report(Fault{"nothing"});
  BOOST_TEST((whole.verdict == MistakeReport::Verdict::right));
  BOOST_TEST(law_of(whole, "angular momentum").is_kept);
  BOOST_TEST(text_of(whole, "toy-py").find("angular momentum: kept to rounding in 2 cases") != std::string::npos,
             text_of(whole, "toy-py"));
  const MistakeReport stale = toy.report(fault_called("stale-inertia"));
  const LawDrift& drift = law_of(stale, "angular momentum");
  BOOST_TEST(!drift.is_kept);
  BOOST_TEST(drift.drift > 1e-4);
  // First order: halving the step halves the drift. A tenth of it is of second order.
  BOOST_TEST(std::abs(drift.at_half_dt / drift.drift - 0.5) < 0.1, drift.at_half_dt << " of " << drift.drift);
  BOOST_TEST(law_of(stale, "linear momentum").is_kept);
  const std::string text = text_of(stale, "toy-py");
  if (stale.verdict == MistakeReport::Verdict::right)
    BOOST_TEST(text.find("unless its scheme keeps angular momentum") != std::string::npos, text);
  BOOST_TEST(text.find("not visible in 2 of 2 cases") != std::string::npos, text);
  BOOST_TEST_MESSAGE(text);
}

BOOST_AUTO_TEST_SUITE_END()
