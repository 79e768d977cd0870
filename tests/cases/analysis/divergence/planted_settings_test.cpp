// rigor diverge on seeded scenes with contacts, joints and drives, in ODE, Bullet, MuJoCo and DART: one setting of a
// run is far from that of the other run, others differ a little. The first must be named. RIGOR_PLANTED=60 tries so
// many scenes and prints each.
#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <map>
#include <set>

#include "cases/analysis/divergence/divergence.h"
#include "core/base/error.h"
#include "tests/cases/analysis/divergence/seeded_scene.h"

using namespace rigor;
using namespace rigor::test;

BOOST_AUTO_TEST_SUITE(cases_analysis_divergence_planted_settings)

namespace {

constexpr double kStep = 1.0 / 240;  // s

struct Plant {
  const char* option;
  std::vector<const char*> values;  // far from the default
};

// Every option of each engine.
const std::vector<Plant>& plants_of(const std::string& method) {
  static const std::vector<Plant>
      ode = {{"gyroscopic", {"off"}},
             {"rotation", {"infinitesimal"}},
             {"erp", {"0.05", "0.9"}},
             {"cfm", {"1e-3", "1e-6"}}},
      quickstep = {{"gyroscopic", {"off"}},   {"rotation", {"infinitesimal"}}, {"erp", {"0.05", "0.9"}},
                   {"cfm", {"1e-3", "1e-6"}}, {"iterations", {"4", "200"}},    {"sor", {"0.5", "1.9"}}},
      impulse = {{"iterations", {"2", "100"}},
                 {"gyroscopic", {"off", "explicit", "implicit-world"}},
                 {"split-impulse", {"off"}},
                 {"erp", {"0.05", "0.9"}},
                 {"cfm", {"1e-2", "1e-3"}}},
      mlcp = {{"gyroscopic", {"off", "explicit", "implicit-world"}},
              {"split-impulse", {"off"}},
              {"erp", {"0.05", "0.9"}},
              {"cfm", {"1e-2", "1e-3"}}},
      multibody = {{"iterations", {"1", "2", "100"}}},
      mujoco = {{"cone", {"pyramidal"}},           {"impratio", {"1", "10000"}}, {"contact-time", {"0.1", "0.005"}},
                {"contact-damping", {"0.2", "4"}}, {"contact-d0", {"0.5"}},      {"contact-dmax", {"0.6"}},
                {"contact-width", {"0.1"}},        {"contact-margin", {"0.05"}}, {"iterations", {"1", "2"}}},
      dart = {{"erp", {"0.02", "0.9"}}, {"cfm", {"1e-2", "1e-4"}}};
  static const std::map<std::string, const std::vector<Plant>*> table = {
      {"ode:worldstep", &ode},      {"ode:quickstep", &quickstep},    {"bullet:sequential-impulse", &impulse},
      {"bullet:mlcp", &mlcp},       {"bullet:multibody", &multibody}, {"mujoco:euler", &mujoco},
      {"mujoco:implicit", &mujoco}, {"mujoco:rk4", &mujoco},          {"dart:dantzig", &dart},
      {"dart:pgs", &dart}};
  return *table.at(method);
}

std::vector<std::string> methods_of(std::size_t engine) {
  static const std::vector<std::vector<std::string>> table = {
      {"ode:worldstep", "ode:quickstep"},
      {"bullet:sequential-impulse", "bullet:mlcp", "bullet:multibody"},
      {"mujoco:euler", "mujoco:implicit", "mujoco:rk4"},
      {"dart:dantzig", "dart:pgs"}};
  return table[engine % table.size()];
}

std::optional<Divergence> diverged(const Scene& scene, const std::string& a, const std::string& b) {
  Case definition;
  definition.id = "planted", definition.scene = scene, definition.duration = 1;
  try {
    const DivergingRun first{parse_run_name(a, engines().infos()), {kStep, "1/240"}},
        second{parse_run_name(b, engines().infos()), {kStep, "1/240"}};
    return diverge(engines(), definition, first, second, default_parting_bounds(scene), {1, 60});
  } catch (const InputError&) {
    return {};  // a scene that blows up at once, or a number out of range
  }
}

// An option with its number moved by a share, or with another word; "" where a rule decides.
std::string moved(const OptionInfo& option, double share) {
  const std::string own = default_value(option, Track::matched).value_or("");
  if (!option.choices.empty())
    return "," + option.name + "=" + (option.choices.back() == own ? option.choices.front() : option.choices.back());
  const double value = std::strtod(own.c_str(), nullptr);
  if (value <= 0) return "";
  if (option.name != "iterations")
    return "," + option.name + "=" + fmt::format("{:.6g}", value * (option.name == "cfm" ? 1 + share : 1 - share));
  return "," + option.name + "=" + std::to_string(static_cast<long>(value + std::ceil(share * value)));
}

struct PlantedRuns {
  std::string a, b, option;
  double parts = 0;  // s: with the planted setting alone
};

// Changes up to three other options as far as they alone keep the runs together for half as long again.
void add_others(const Scene& scene, SeededNumbers& n, const RunName& run, PlantedRuns& runs) {
  const std::vector<OptionInfo>& options = method_of(engines().info_of(run.engine), run.settings).options;
  std::string others;
  std::set<std::size_t> chosen;
  for (int k = 0; k < 3; ++k) chosen.insert(n.below(options.size()));
  for (const std::size_t one : chosen) {
    for (const double share : {0.3, 0.03, 0.003}) {
      const std::string text = options[one].name == runs.option ? "" : moved(options[one], share);
      if (text.empty()) break;
      const auto without = diverged(scene, runs.a, runs.a + others + text);
      const bool stays = without && !(without->parting && without->parting->time < 1.5 * runs.parts);
      if (stays) others += text;
      if (stays || !options[one].choices.empty()) break;
    }
  }
  runs.b += others;
}

// Runs that part by the planted setting.
std::optional<PlantedRuns> planted_runs(const Scene& scene, SeededNumbers& n, std::size_t engine) {
  const std::vector<std::string> methods = methods_of(engine);
  PlantedRuns runs;
  runs.a = methods[n.below(methods.size())];
  const std::vector<Plant>& plants = plants_of(runs.a);
  const Plant& plant = plants[n.below(plants.size())];
  runs.option = plant.option, runs.b = runs.a + "," + plant.option + "=" + plant.values[n.below(plant.values.size())];
  const auto alone = diverged(scene, runs.a, runs.b);
  if (!alone || !alone->parting) return {};
  runs.parts = alone->parting->time;
  add_others(scene, n, alone->a.name, runs);
  return runs;
}

std::string words_of(const TriedSwap& swap) {
  std::string text;
  for (const SettingSwap& one : swap.swaps) text += (text.empty() ? "" : " and ") + name_of(one);
  return text;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_planted_setting_is_named_first) {
  const char* asked = std::getenv("RIGOR_PLANTED");
  const std::size_t count = asked ? std::strtoul(asked, nullptr, 10) : 8;
  std::size_t tried = 0, named = 0;
  for (unsigned seed = 1; tried < count; ++seed) {
    const Scene scene = seeded_scene(seed);
    SeededNumbers n(seed + 1000);
    const auto runs = planted_runs(scene, n, tried);
    if (!runs) continue;
    const auto found = diverged(scene, runs->a, runs->b);
    BOOST_TEST_REQUIRE((found && found->parting), runs->b);
    const auto& best = found->swaps.best;
    const bool is_right = best && best->swaps.front().option == runs->option;
    ++tried, named += is_right;
    BOOST_TEST_MESSAGE(
        "scene " << seed << ", " << runs->b << ": parts at " << found->parting->time << " s (" << runs->parts << " s), "
                 << (is_right ? "named" : "MISNAMED") << ": "
                 << (best ? words_of(*best)
                          : "nothing; first " + words_of(found->swaps.tried.front()) +
                                fmt::format(", {:.3g}, {:.3g} at half the step", found->swaps.tried.front().closes,
                                            found->swaps.tried.front().closes_at_half_step)));
  }
  BOOST_TEST_MESSAGE(named << " of " << tried << " named");
  BOOST_TEST(static_cast<double>(named) >= 0.95 * static_cast<double>(tried));
}

BOOST_AUTO_TEST_SUITE_END()
