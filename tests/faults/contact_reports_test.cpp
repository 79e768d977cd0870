// Wrong reports of contact forces, in each engine that reports them: a gate of forces-of-contact/ must find each.
#include <algorithm>
#include <boost/test/unit_test.hpp>

#include "adapters/engines.h"
#include "adapters/faults/broken_engine.h"
#include "adapters/faults/faults.h"
#include "cases/metrics/metric.h"
#include "cases/runner/simulate.h"
#include "core/engine/engine_failure.h"
#include "core/engine/run_name.h"
#include "tests/cases/truth/closed_form/contact/contact_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(faults_contact_reports)

namespace {

constexpr double kStep = 1.0 / 240;
constexpr double kMostUnbalanced = 1e-6, kMostOutside = 1e-6;  // N: the bounds of the family, for roundings
constexpr double kSunk = 0.005, kMostGapError = 0.001;         // m: engines put the points of an overlap differently

// A box that a level force cannot move, so that friction acts all the time.
Scene held_box() {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  scene.bodies = {test::on_its_own("box", Box{{0.4, 0.4, 0.2}}, 10, {0, 0, 0.1}), test::plane()};
  scene.forces = {{.body = 0, .force = Vec3(20, 10, 0)}};
  scene.contact_default = {0, 0.5};
  return scene;
}

double value_of(const std::string& metric, const Scene& scene, const Trajectory& run) {
  const auto row = std::find_if(metrics().begin(), metrics().end(),
                                [&](const MetricRow& candidate) { return candidate.name == metric; });
  return row->measure({scene, run, nullptr, 0}).measurement->value;
}

// Whether the bounds of the family, or the reader of reports, refuse the run.
bool is_found(const Engine& engine, const Settings& settings, const Scene& scene, bool has_overlaps) {
  try {
    const Trajectory run = simulate(engine, settings, scene, kStep, 0.5, {.has_contacts = true}).trajectory;
    BOOST_TEST_REQUIRE((run.contacts == ContactRecords::kept));
    Scene sunk = scene;
    sunk.bodies[0].position.z() -= kSunk;
    const Trajectory step = simulate(engine, settings, sunk, kStep, kStep, {.has_contacts = true}).trajectory;
    return value_of("contact_balance", scene, run) > kMostUnbalanced ||
           value_of("coulomb_residual", scene, run) > kMostOutside ||
           (has_overlaps && value_of("contact_gap_error", sunk, step) > kMostGapError);
  } catch (const EngineFailure& failure) {
    return failure.kind() == FailureKind::invalid;
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_wrong_report_is_found_in_each_engine) {
  const Scene scene = held_box();
  const auto infos = engines().infos();
  // ODE and DART brake by a pyramid, whose corners lie outside the cone: their correct reports are not within it.
  for (const char* text : {"core:velocity-verlet,contact=event", "core:velocity-verlet,contact=impulse", "bullet",
                           "bullet:mlcp", "bullet:multibody", "mujoco"}) {
    const std::string name = text, engine = name.substr(0, name.find(':'));
    if (std::none_of(infos.begin(), infos.end(), [&](const EngineInfo& info) { return info.name == engine; })) continue;
    const RunName run = parse_run_name(name, infos);
    const Engine& sound = find_engine(engines(), run.engine);
    // Events part bodies that overlap, and their contacts have a gap of zero, whose sign is none.
    const bool has_overlaps = name.find("contact=event") == std::string::npos;
    BOOST_TEST(!is_found(sound, run.settings, scene, has_overlaps), name << " as it is");
    for (const Fault& fault : contact_report_faults()) {
      if (!has_overlaps && fault.name == "contact gap with the wrong sign") continue;
      const BrokenEngine broken(sound, fault);
      BOOST_TEST(is_found(broken, run.settings, scene, has_overlaps), name << ": " << fault.name);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
