// Every scene of the suite with a closed form, changed in one place after another. The form must refuse the scene, or
// be correct for it. The comparison is the core's adaptive method, with contact by events.
#include <fmt/format.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <optional>

#include "cases/truth/distance.h"
#include "cases/truth/provenance.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"
#include "tests/cases/judged.h"
#include "tests/cases/suite/suite_checks.h"
#include "tests/cases/truth/closed_form/spoilt_scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_truth_closed_form_spoilt_scenes)

namespace {

constexpr double kLongest = 0.6, kStep = 1.0 / 128;  // s: of a comparison, and of a sample
// Relative to the scene's size or a radian: a tenth of a per mille of each change. The core's own errors are below
// 1e-9, except at the instant of an impact; afterwards they are this value times a change of velocity.
constexpr double kAgrees = 1e-5;
constexpr std::size_t kMostBodies = 7;  // of a scene that touches: 25 balls on a box by events would take minutes

std::unique_ptr<Truth> truth_or_refusal(const std::string& kind, const Scene& scene, double duration) {
  try {
    return make_truth(kind, scene, duration);
  } catch (const InputError&) {
    return nullptr;
  }
}

// The core's own opinion; none at a singular position, nor of shapes that contact by events lacks.
std::optional<Trajectory> core_run(const Scene& scene, double duration) {
  Settings settings = test::core_method("dormand-prince");
  const bool touches = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const Body& b) { return b.collides; });
  if (touches && !test::takes_contact_by_events(scene)) return {};
  if (touches) settings.options["contact"] = "event";
  try {
    Simulation run = simulate(find_engine(engines(), "core"), settings, scene, kStep, duration);
    if (run.solver_warning.empty()) return run.trajectory;
    std::erase_if(run.trajectory.samples, [&](const Sample& s) { return s.time >= run.solver_warning_time; });
    return run.trajectory;
  } catch (const EngineFailure&) {
    return {};
  }
}

// The first sample at which they are apart by more than they may be while the truth is good.
std::optional<std::string> where_apart(const Truth& truth, const Trajectory& run) {
  for (const Sample& sample : run.samples) {
    const BodyColumns bodies = sample.bodies.columns();
    double size = 1;
    for (std::size_t i = 0; i < bodies.size(); ++i) size = std::max(size, bodies.position(i).norm());
    const double error = truth.error(sample.time);
    if (!(error < kAgrees)) return {};
    const BodyTable expected = test::truth_at(truth, sample.time, bodies.size());
    const double apart = distance_between(expected.columns(), bodies);
    if (!(apart <= kAgrees * size + error)) return fmt::format("{:.3g} apart at {:.3g} s", apart, sample.time);
  }
  return {};
}

struct Tally {
  int refused = 0, held = 0, unjudged = 0;
};

void spoil(const Case& c, Tally& tally) {
  const double duration = std::min(c.duration, kLongest);
  for (const test::Change& change : test::changes_of(c.scene)) {
    Scene scene = c.scene;
    change.make(scene);
    if (!test::is_a_scene(scene)) continue;
    const auto truth = truth_or_refusal(c.truth, scene, duration);
    if (!truth) {
      ++tally.refused;
      BOOST_TEST((change.what != "nothing"), c.id);
      continue;
    }
    const auto run = core_run(scene, duration);
    ++(run ? tally.held : tally.unjudged);
    const auto apart = run ? where_apart(*truth, *run) : std::nullopt;
    BOOST_TEST(!apart, c.truth << ", " << c.id << ", " << change.what << ": " << apart.value_or(""));
  }
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_closed_form_refuses_what_it_does_not_hold_for) {
  Tally tally;
  for (const Case& c : test::suite_cases([](const Case& one) {
         return provenance_of(one.truth).starts_with("a closed form") && one.scene.bodies.size() <= kMostBodies;
       }))
    spoil(c, tally);
  BOOST_TEST_MESSAGE(tally.refused << " refused, " << tally.held << " that hold, " << tally.unjudged
                                   << " of which the core has no opinion");
  BOOST_TEST(tally.refused > 0);
  BOOST_TEST(tally.held > 0);
}

BOOST_AUTO_TEST_SUITE_END()
