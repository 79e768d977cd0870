// The cases whose contact forces statics determines, against its closed forms: two schemes' reports, and the judge's
// own equations.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "adapters/engines.h"
#include "cases/case/suite.h"
#include "cases/metrics/measures/contact/true_wrenches.h"
#include "cases/runner/simulate.h"
#include "core/dynamics/model/system.h"
#include "core/engine/run_name.h"
#include "tests/cases/vocabulary.h"

BOOST_AUTO_TEST_SUITE(cases_metrics_measures_contact_static_shares)

using namespace rigor;

namespace {

struct StaticShare {
  std::string name, first, second;
  Vec3 force;  // N, on the second
};

constexpr double kWeight = 98.1;  // N, of 10 kg

std::vector<StaticShare> shares() {
  // The walls are tangents of the roller: N (n_left + n_right) carries the weight, with n_z = r / z = 0.6.
  const double groove = kWeight / (2 * 0.1 / 0.16666666666666666);
  // Virtual work: if the foot slides by dx, the ladder turns about the point above the foot beside its head, 2.4 m up,
  // and the centre of mass sinks by (0.7 - 0.374) / 2.4 dx.
  const double wall = kWeight * (0.7 - 0.374) / 2.4;
  // The levers about the right edge are 1 m of the beam, 4/3 m of the load, and 2 m of the left edge.
  const double left = 9.81 * (6 * 1 + 3 * 4.0 / 3) / 2, right = 9.81 * (6 + 3) - left;
  return {{"v-groove", "left wall", "roller", groove * Vec3(0.8, 0, 0.6)},
          {"v-groove", "right wall", "roller", groove * Vec3(-0.8, 0, 0.6)},
          {"ladder", "wall", "ladder", {wall, 0, 0}},
          {"ladder", "ground", "ladder", {-wall, 0, kWeight}},
          {"beam-on-scales", "left edge", "beam", {0, 0, left}},
          {"beam-on-scales", "right edge", "beam", {0, 0, right}}};
}

Case case_of(const std::string& name) {
  return select_cases({"forces-of-contact/" + name}, default_suite_dir(), test::words()).front();
}

BodyPair pair_named(const Scene& scene, const StaticShare& share) {
  const auto index = [&](const std::string& name) {
    for (std::size_t i = 0; i < scene.bodies.size(); ++i)
      if (scene.bodies[i].name == name) return static_cast<int>(i);
    return kWorld;
  };
  return {index(share.first), index(share.second)};
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_numbers_of_the_case_files_are_those_of_the_formulas) {
  const std::vector<StaticShare> all = shares();
  BOOST_TEST(std::abs(all[0].force.norm() - 81.75) < 1e-12);
  BOOST_TEST(std::abs(all[2].force.x() - 13.32525) < 1e-12);
  BOOST_TEST(std::abs(all[4].force.z() - 49.05) < 1e-12);
  BOOST_TEST(std::abs(all[5].force.z() - 39.24) < 1e-12);
}

// The starts overlap by some 1e-12 m, of levers of a metre and forces of 100 N.
BOOST_AUTO_TEST_CASE(the_judges_equations_give_the_closed_forms) {
  for (const StaticShare& share : shares()) {
    const Scene scene = case_of(share.name).scene;
    BodyTable start(scene.bodies.size());
    set_initial_state(scene, start.columns());
    const Equilibrium found = wrenches_at_rest(scene, std::as_const(start).columns());
    const DueWrench& due = found.pairs.at(pair_named(scene, share));
    BOOST_TEST_CONTEXT(share.name << ": " << share.first) {
      BOOST_TEST(counts_fully(due.force_counts));
      BOOST_TEST((due.wrench.force - share.force).norm() < 1e-9);
    }
  }
}

BOOST_AUTO_TEST_CASE(contact_by_events_reports_the_closed_forms_at_each_step) {
  const RunName run = parse_run_name("core:velocity-verlet,contact=event", test::words().engines);
  for (const StaticShare& share : shares()) {
    const Scene scene = case_of(share.name).scene;
    const BodyPair pair = pair_named(scene, share);
    const Trajectory moved =
        simulate(find_engine(engines(), run.engine), run.settings, scene, 1.0 / 240, 0.1, {.has_contacts = true})
            .trajectory;
    BOOST_TEST_REQUIRE(moved.samples.size() > 20u);
    double worst = 0;
    for (std::size_t n = 1; n < moved.samples.size(); ++n) {
      const PairForces forces = reported_pair_forces(scene, moved.samples[n]);
      const auto found = forces.find(pair);
      const Vec3 force = found == forces.end() ? Vec3(Vec3::Zero()) : found->second;
      worst = std::max(worst, (force - share.force).norm());
    }
    BOOST_TEST(worst < 2e-10, share.name << ": " << share.first << " is off by " << worst << " N");
  }
}

BOOST_AUTO_TEST_SUITE_END()
