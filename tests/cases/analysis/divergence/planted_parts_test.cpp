// rigor diverge on seeded scenes with contacts, joints and drives, in ODE, Bullet, MuJoCo and DART: one part of the
// scene differs between two engines that are else the same. The part and its body are named, and no instant before the
// first at which any number differs. RIGOR_PLANTED=60 tries so many scenes and prints each.
#include <boost/test/unit_test.hpp>
#include <cstdlib>

#include "cases/analysis/divergence/divergence.h"
#include "cases/analysis/repeats/recorded_states.h"
#include "tests/cases/analysis/divergence/changed_engine.h"
#include "tests/cases/analysis/divergence/seeded_scene.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_analysis_divergence_planted_parts)

namespace {

constexpr double kStep = 1.0 / 240;  // s
constexpr long kSteps = 240;

struct PlantedPart {
  std::string name;         // as a cause is named
  std::vector<int> bodies;  // of which one may be named
  Scene scene;
  std::function<void(Scene&)> change;
};

std::vector<int> links_of(const Scene& scene) {
  std::vector<int> links;
  for (const Joint& joint : scene.joints) links.push_back(joint.b);
  return links;
}

PlantedPart planted_part(unsigned seed) {
  SeededNumbers n(seed + 2000);
  PlantedPart part;
  Scene& scene = part.scene = seeded_scene(seed);
  const int body = static_cast<int>(n.below(2)),
            ground = static_cast<int>(scene.bodies.size() - scene.joints.size() - 1);
  const double factor = n.coin() ? n.between(1.2, 2) : n.between(0.3, 0.8);
  const std::string& name = scene.bodies[static_cast<std::size_t>(body)].name;
  switch (n.below(4)) {
    case 0:
      part.name = "the drive of " + scene.joint_name(static_cast<std::size_t>(scene.motors[0].joint));
      part.bodies = links_of(scene);
      part.change = [factor](Scene& s) {
        for (Motor& motor : s.motors) {
          motor.effort *= factor;
          if (motor.servo) motor.servo->kp *= factor;
        }
      };
      break;
    case 1:
      scene.contact_pairs.push_back({body, ground, scene.contact_default});
      part.name = "the friction of '" + name + "' and 'ground'", part.bodies = {body};
      part.change = [factor](Scene& s) {
        for (ContactPair& pair : s.contact_pairs) pair.law.friction *= factor;
      };
      break;
    case 2:
      scene.joints[0].stiffness = n.between(5, 20), scene.joints[0].rest = n.between(-0.5, 0.5);
      part.name = "the spring and damper of " + scene.joint_name(0), part.bodies = links_of(scene);
      part.change = [factor](Scene& s) {
        for (Joint& joint : s.joints) joint.stiffness *= factor;
      };
      break;
    default:
      TimedForce force;
      force.body = body, force.force = {n.between(-5, 5), n.between(-5, 5), n.between(0, 5)};
      force.from = n.between(0, 0.4), force.until = force.from + n.between(0.1, 0.5);
      scene.forces = {force};
      part.name = "the timed force on '" + name + "'", part.bodies = {body};
      part.change = [factor](Scene& s) {
        for (TimedForce& own : s.forces) own.force *= factor;
      };
  }
  return part;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_planted_part_its_body_and_its_instant_are_named) {
  const char* asked = std::getenv("RIGOR_PLANTED");
  const std::size_t count = asked ? std::strtoul(asked, nullptr, 10) : 8;
  const std::vector<std::string> names = {"ode", "bullet", "mujoco", "dart"};
  std::size_t tried = 0, right = 0;
  for (unsigned seed = 1; tried < count; ++seed) {
    const std::string& engine = names[seed % names.size()];
    const PlantedPart part = planted_part(seed);
    EngineTable table = built_in_engines();
    table.add(std::make_unique<ChangedEngine>(engine, part.change));
    const DivergingRun a{parse_run_name(engine, table.infos()), {kStep, "1/240"}},
        b{parse_run_name("changed", table.infos()), {kStep, "1/240"}};
    Case definition;
    definition.id = "planted", definition.scene = part.scene, definition.duration = kStep * kSteps;
    if (!why_unsupported(table.info_of(engine), a.name.settings, part.scene, kStep).empty())
      continue;  // capsules in DART
    const Divergence found = diverge(table, definition, a, b, default_parting_bounds(part.scene), {1, 60});
    if (!found.parting) continue;  // a force that ends before it matters, a body that never slides
    const auto states = [&](const DivergingRun& run) {
      return recorded(table.find(run.name.engine), run.name.settings, part.scene, kStep, kSteps);
    };
    const auto difference = first_difference(states(a), states(b));
    BOOST_TEST_REQUIRE(difference.has_value());
    const Cause* cause = found.causes.empty() ? nullptr : &found.causes.front();
    const bool is_part = cause && cause->what == part.name;
    const bool is_body = cause && std::count(part.bodies.begin(), part.bodies.end(), cause->at.body) == 1;
    const bool is_instant = cause && cause->at.time >= kStep * (static_cast<double>(difference->step) - 1.5);
    ++tried, right += is_part && is_body && is_instant;
    std::string evidence;
    for (std::size_t k = 0; !is_part && cause && k < std::min<std::size_t>(3, cause->evidence.size()); ++k)
      evidence += "; " + cause->evidence[k].what + ": " + std::to_string(cause->evidence[k].share);
    BOOST_TEST_MESSAGE("scene " << seed << ", " << engine << ", " << part.name << ": parts at " << found.parting->time
                                << " s, " << (is_part ? "named" : "MISNAMED") << (is_body ? "" : ", ANOTHER BODY")
                                << (is_instant ? "" : ", TOO EARLY") << ": "
                                << (cause ? cause->what + " at " + std::to_string(cause->at.time) : "nothing")
                                << evidence);
  }
  BOOST_TEST_MESSAGE(right << " of " << tried << " right");
  BOOST_TEST(static_cast<double>(right) >= 0.95 * static_cast<double>(tried));
}

BOOST_AUTO_TEST_SUITE_END()
