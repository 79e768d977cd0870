// Engines under exact relations between scenes (relations.h). An engine that breaks a relation has a row in the table
// of facts. The test also fails if the relation holds again.
#include <boost/test/unit_test.hpp>

#include "adapters/engines.h"
#include "tests/relations/comparison.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(relations_engines)

namespace {

constexpr const char* kScale = "thresholds and regularisation in SI units";
constexpr const char* kOrder = "constraints are solved one after another";
constexpr const char* kAxes = "the rows of a joint, or the directions of friction, depend on the axes of the world";
constexpr const char* kGaps = "the gap of a joint is its own, and is corrected over several steps; a restart closes it";
constexpr const char* kTree = "joints that close no tree are coordinates of it, and another root has other errors";
constexpr const char* kPyramid = "friction is a pyramid in the axes of the world";
constexpr const char* kSkewed =
    "the directions of friction on a slope are not at right angles (adapters/siconos/README.md)";
constexpr const char* kSolver = "the solver iterates over all bodies together, up to a tolerance";

// The counts are those of 30 scenes, or of eight for slow engines. They may differ by a few where libraries round
// differently. The bound is 1e-8 m and rad.
const std::vector<test::Fact> kFacts = {
    {"bullet", "mechanisms", "restarted", 20, 27, kGaps},    {"bullet", "mechanisms", "shuffled", 12, 25, kOrder},
    {"bullet", "mechanisms", "turned", 14, 26, kAxes},       {"bullet", "mechanisms", "welded halves", 1, 3, kOrder},
    {"bullet", "on a plane", "other units", 1, 5, kScale},   {"bullet", "on a plane", "turned", 1, 4, kAxes},
    {"bullet", "in flight", "boosted", 1, 3, kScale},        {"bullet", "in flight", "other units", 2, 8, kScale},
    {"bullet", "in flight", "shuffled", 2, 8, kOrder},       {"bullet", "in flight", "turned", 1, 4, kAxes},
    {"bullet", "in flight", "welded halves", 1, 3, kOrder},  {"dart", "mechanisms", "shuffled", 4, 11, kTree},
    {"dart", "on a plane", "other units", 1, 4, kScale},     {"dart", "on a plane", "turned", 4, 11, kPyramid},
    {"dart", "in flight", "other units", 1, 4, kScale},      {"dart", "in flight", "turned", 1, 4, kPyramid},
    {"mujoco", "mechanisms", "restarted", 1, 3, kGaps},      {"mujoco", "mechanisms", "shuffled", 3, 9, kTree},
    {"mujoco", "on a plane", "other units", 10, 13, kScale}, {"mujoco", "in flight", "other units", 2, 4, kScale},
    {"mujoco3", "mechanisms", "shuffled", 1, 2, kTree},      {"mujoco3", "on a plane", "other units", 1, 2, kScale},
    {"mujoco3", "in flight", "other units", 1, 1, kScale},   {"ode", "mechanisms", "far body", 1, 5, kSolver},
    {"ode", "mechanisms", "other units", 5, 14, kScale},     {"ode", "mechanisms", "restarted", 24, 28, kGaps},
    {"ode", "on a plane", "far body", 1, 6, kSolver},        {"ode", "in flight", "far body", 1, 5, kSolver},
    {"siconos", "on a plane", "mirrored", 3, 7, kSkewed},    {"siconos", "on a plane", "other units", 1, 3, kScale},
    {"siconos", "on a plane", "turned", 3, 7, kSkewed},      {"siconos", "in flight", "far body", 1, 3, kSolver},
    {"siconos", "in flight", "mirrored", 1, 5, kSkewed},     {"siconos", "in flight", "other units", 1, 4, kScale},
    {"siconos", "in flight", "shuffled", 3, 7, kSolver},     {"siconos", "in flight", "turned", 1, 5, kSkewed},
};

}  // namespace

BOOST_AUTO_TEST_CASE(engines_keep_relations_but_for_known_facts) {
  for (const auto& engine : engines()) {
    const EngineInfo& info = engines().info_of(engine->info().name);
    if (info.is_in_house) continue;
    const test::MotionSource run = test::run_of_engine(info.name, 1.0 / 200, 100, 1e-8);
    const bool is_slow = engine->is_remote() || info.name == "simbody";
    for (const char* scenes : {"smooth", "mechanisms", "on a plane", "in flight"})
      test::check(run, scenes, is_slow ? 8 : 30, kFacts);
  }
}

BOOST_AUTO_TEST_SUITE_END()
