// The default that the table states for an option is the value in force where a run does not name it.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "core/engine/option_values.h"
#include "tests/adapters/hung_rods.h"
#include "tests/adapters/seam_runs.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(adapters_option_defaults)

namespace {

constexpr double kDt = 1.0 / 120;
constexpr int kSteps = 40;

// A spinning body, bodies that bounce, bodies that do not, rods on joints, and such that a servo turns: each option
// acts in one of them at least.
std::vector<Scene> scenes() {
  Joint joint{.a = 0, .b = 1, .type = HingeJoint{{1, 0.1, 0}, {0, 0, 1}}};
  Scene inelastic = small_pile();  // MuJoCo has no restitution
  inelastic.contact_default.restitution = 0;
  Scene driven = hung_by(joint);
  Motor motor{.joint = static_cast<int>(driven.joints.size()) - 1};
  motor.servo = Servo{.target = TimeTable::constant(0.5), .kp = 5, .kd = 0.5};
  driven.motors = {motor};
  return {scene_of(moving_body()), small_pile(), inelastic, hung_by(joint), driven};
}

// Siconos aborts by an assertion of its own ("PivotJoint, _A1 wrong") as soon as this hinge has turned.
bool is_asked(const Run& run, const Scene& scene) {
  return run.supports(scene, kDt) && (run.info.name != "siconos" || scene.joints.empty());
}

struct Outcome {
  SettingsInForce settings;
  BodyTable state;
};

bool are_same(const Outcome& a, const Outcome& b) { return a.settings == b.settings && same_bits(a.state, b.state); }

Outcome outcome_of(const Run& run, const Scene& scene) {
  const auto world = run.load(scene);
  Outcome outcome;
  outcome.settings = world->settings_in_force();
  outcome.state = state_after(*world, kDt, kSteps);
  return outcome;
}

bool is_allowed(const OptionInfo& option, const OptionDefault& value) {
  if (const auto* rule = std::get_if<DefaultRule>(&value)) return !rule->text.empty();
  const auto* number = std::get_if<double>(&value);
  if (!option.choices.empty()) {
    const auto* word = std::get_if<std::string>(&value);
    return word && std::count(option.choices.begin(), option.choices.end(), *word) == 1;
  }
  return number && *number >= option.min && *number <= option.max && (!option.whole || *number == std::floor(*number));
}

// A value far from the default.
std::string other_value(const OptionInfo& option, Track track) {
  const std::string by_default = default_value(option, track).value_or("");
  for (const std::string& choice : option.choices) {
    if (choice != by_default) return choice;
  }
  const std::string most = fmt::format("{}", option.max);
  return most == by_default ? fmt::format("{}", option.min) : most;
}

}  // namespace

BOOST_AUTO_TEST_CASE(every_option_of_every_method_states_a_default_that_it_allows) {
  int options = 0;
  for (const EngineInfo& engine : infos_of(engines())) {
    for (const MethodInfo& method : engine.methods) {
      for (const OptionInfo& option : method.options) {
        ++options;
        BOOST_TEST_CONTEXT(engine.name + ":" + method.name + " " + option.name) {
          BOOST_TEST(is_allowed(option, default_of(option, Track::matched)));
          BOOST_TEST(is_allowed(option, default_of(option, Track::stock)));
          BOOST_TEST(!default_text(option).empty());
          BOOST_TEST(option.meaning.find("default") == std::string::npos);  // the table is the only place
        }
      }
    }
  }
  BOOST_TEST(options > 50);
}

// Compares what the engine reads back and every bit of the motion.
BOOST_AUTO_TEST_CASE(an_option_at_its_default_changes_neither_a_setting_nor_a_bit) {
  const std::vector<Scene> all = scenes();
  std::map<std::string, int> equal;
  for (Run run : all_runs()) {
    for (const Scene& scene : all) {
      run.settings.options.clear();
      if (!is_asked(run, scene)) continue;
      const Outcome unnamed = outcome_of(run, scene);
      for (const OptionInfo& option : run.method().options) {
        const auto value = default_value(option, run.settings.track);
        if (!value) continue;
        run.settings.options = {{option.name, *value}};
        BOOST_TEST(are_same(outcome_of(run, scene), unnamed), run.name() << " " << option.name << "=" << *value);
        ++equal[run.info.name];
      }
    }
  }
  for (const EngineInfo& engine : infos_of(engines())) {
    const bool has_options = std::any_of(engine.methods.begin(), engine.methods.end(),
                                         [](const MethodInfo& method) { return !method.options.empty(); });
    if (has_options) BOOST_TEST(equal[engine.name] > 0, engine.name);
  }
}

// Otherwise the comparison above could not fail. Options of the core act only in scenes of their own tests.
BOOST_AUTO_TEST_CASE(another_value_is_seen_for_every_option_of_an_external_engine) {
  const std::vector<Scene> all = scenes();
  std::map<std::string, bool> is_seen;  // by engine and option
  for (Run run : all_runs()) {
    if (run.settings.track == Track::stock || run.info.is_in_house) continue;
    for (const Scene& scene : all) {
      run.settings.options.clear();
      if (!is_asked(run, scene)) continue;
      const Outcome unnamed = outcome_of(run, scene);
      for (const OptionInfo& option : run.method().options) {
        bool& seen = is_seen[run.info.name + " " + option.name];
        run.settings.options = {{option.name, other_value(option, run.settings.track)}};
        if (!seen && run.supports(scene, kDt)) seen = !are_same(outcome_of(run, scene), unnamed);
      }
    }
  }
  for (const auto& [name, seen] : is_seen) BOOST_TEST(seen, name);
}

BOOST_AUTO_TEST_SUITE_END()
