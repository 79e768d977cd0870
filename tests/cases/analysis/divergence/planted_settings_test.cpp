// rigor diverge on seeded scenes with contacts, joints and drives, in ODE, Bullet, MuJoCo and DART: one setting of a
// run is far from that of the other run, others differ a little. The first must be named. RIGOR_PLANTED=60 tries so
// many scenes and prints each.
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
  const DivergingRun first{parse_run_name(a, engines().infos()), {kStep, "1/240"}},
      second{parse_run_name(b, engines().infos()), {kStep, "1/240"}};
  try {
    return diverge(engines(), definition, first, second, default_parting_bounds(scene), {1, 60});
  } catch (const InputError&) {
    return {};  // an engine that the scene blows up at once
  }
}

// The numbers of other options, moved by a share of their value.
std::string moved_options(const Divergence& found, const std::string& planted, double share) {
  std::string text;
  for (const OptionInfo& option : method_of(engines().info_of(found.a.name.engine), found.a.name.settings).options) {
    if (option.name == planted || !option.choices.empty()) continue;
    const auto in_force =
        std::find_if(found.in_a.begin(), found.in_a.end(), [&](const auto& row) { return row.first == option.name; });
    char* end = nullptr;
    const double value = in_force == found.in_a.end() ? 0 : std::strtod(in_force->second.c_str(), &end);
    if (value <= 0 || (end && *end != '\0')) continue;
    const bool is_count = option.name == "iterations";
    const double other = is_count ? value + std::ceil(share * value) : value * (1 - share);
    text += "," + option.name + "=" + (is_count ? std::to_string(static_cast<long>(other)) : std::to_string(other));
  }
  return text;
}

struct PlantedRuns {
  std::string a, b, option;
  double parts = 0;  // s: with the planted setting alone
};

// Runs that part by the planted setting. The other settings alone keep them together for half as long again.
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
  for (const double share : {0.1, 0.03, 0.01, 1e-3, 1e-4}) {
    const std::string others = moved_options(*alone, plant.option, share);
    if (others.empty()) break;
    const auto without = diverged(scene, runs.a, runs.a + others);
    if (without && without->parting && without->parting->time < 1.5 * runs.parts) continue;
    runs.b += others;
    break;
  }
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
    const bool is_right = best && best->swaps.size() == 1 && best->swaps.front().option == runs->option;
    ++tried, named += is_right;
    BOOST_TEST_MESSAGE("scene " << seed << ", " << runs->b << ": parts at " << found->parting->time << " s ("
                                << runs->parts << " s), " << (is_right ? "named" : "MISNAMED") << ": "
                                << (best ? words_of(*best) : "nothing; first " + words_of(found->swaps.tried.front())));
  }
  BOOST_TEST_MESSAGE(named << " of " << tried << " named");
  BOOST_TEST(static_cast<double>(named) >= 0.95 * static_cast<double>(tried));
}

BOOST_AUTO_TEST_SUITE_END()
