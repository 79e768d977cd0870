#include "cases/case/family.h"

#include <boost/test/unit_test.hpp>
#include <set>

#include "cases/case/suite.h"
#include "tests/cases/vocabulary.h"
#include "tests/core/scene/toml/refusal.h"
#include "tests/folder.h"

using namespace rigor;

namespace cases_case_family {

const std::string kCase = R"(title = 'x'
[scene]
body = [{ name = 'a', mass = 1, inertia = [1, 1, 1] }]
gravity = [0, 0, 0]
[run]
duration = 1
dt = ['1/10', '1/20', '1/40']
[truth]
kind = 'projectile'
)";
const std::string kSpring = "[[scene.spring]]\na = 'world'\nb = 'a'\npoint_a = [0, 1, 0]\nstiffness = 1\n";

// A suite of two cases, the second with a spring, and what their family says.
struct Suite : Folder {
  std::vector<Case> cases_with(const std::string& family, const std::string& own = "") {
    write("suite/swings/free.toml", kCase + own);
    write("suite/swings/sprung.toml", kCase + kSpring);
    write("suite/swings/family.toml", family);
    return select_cases({}, (path / "suite").string(), test::words());
  }
};

std::string gate(const std::string& rest) { return "[[gate]]\nmetric = 'energy_drift'\nbecause = 'x'\n" + rest + "\n"; }

}  // namespace cases_case_family

BOOST_FIXTURE_TEST_SUITE(cases_case_family, Suite)

BOOST_AUTO_TEST_CASE(a_familys_gates_hold_for_each_of_its_cases) {
  const auto cases = cases_with(gate("max = 1") + gate("engines = 'core:* order=4'\ndt = '<=1/20'\nmin = 0"));
  BOOST_TEST_REQUIRE(cases.size() == 2u);  // the family is no case
  for (const Case& c : cases) {
    BOOST_TEST_REQUIRE(c.gates.size() == 2u);
    BOOST_TEST(c.gates[0].is_of_family);
    BOOST_TEST(c.gates[0].bound().max.value() == 1);
    BOOST_TEST(c.gates[0].where.ends_with("swings/family.toml:1:1"));
    BOOST_TEST(c.gates[1].dt.size() == 2u);
    BOOST_TEST(c.gates[1].dt.front().text == "1/20");
    BOOST_TEST(
        (std::find(c.gates[1].engines.begin(), c.gates[1].engines.end(), "core:rk4") != c.gates[1].engines.end()));
  }
}

BOOST_AUTO_TEST_CASE(a_gate_may_be_about_scenes_and_truths_of_a_kind) {
  const auto count = [&](const std::string& rest) {
    const auto cases = cases_with(gate("max = 1\n" + rest));
    return std::pair{cases[0].gates.size(), cases[1].gates.size()};
  };
  BOOST_TEST((count("scene = ['spring']") == std::pair<std::size_t, std::size_t>{0, 1}));
  BOOST_TEST((count("scene = ['!spring']") == std::pair<std::size_t, std::size_t>{1, 0}));
  BOOST_TEST((count("scene = ['!contact', '!damping', '!gravity']") == std::pair<std::size_t, std::size_t>{1, 1}));
  BOOST_TEST((count("scene = ['gravity']") == std::pair<std::size_t, std::size_t>{0, 0}));
  BOOST_TEST((count("truth = ['projectile', 'bounce']") == std::pair<std::size_t, std::size_t>{1, 1}));
  BOOST_TEST((count("truth = 'bounce'") == std::pair<std::size_t, std::size_t>{0, 0}));
  BOOST_TEST((count("except = 'free'") == std::pair<std::size_t, std::size_t>{0, 1}));
  BOOST_TEST((count("dt = '1/30'") == std::pair<std::size_t, std::size_t>{0, 0}));  // no case has such a step
}

BOOST_AUTO_TEST_CASE(one_table_may_speak_of_several_metrics) {
  const auto cases = cases_with("[[gate]]\nmetric = ['energy_drift', 'energy_gain']\nmax = 1\nbecause = 'x'");
  BOOST_TEST_REQUIRE(cases[0].gates.size() == 2u);
  BOOST_TEST(cases[0].gates[1].metric == "energy_gain");
}

BOOST_AUTO_TEST_CASE(a_case_that_states_an_order_or_a_regression_of_a_run_itself_is_held_to_its_own) {
  const std::string family = gate("engines = ['core:rk4', 'core:rkmk4']\nat_least_order = 'declared'") +
                             gate("engines = ['ode', 'bullet']\nregression = 1.5");
  const auto cases = cases_with(
      family, gate("engines = 'core:rk4'\nat_least_order = 2") + gate("engines = ['ode', 'bullet']\nregression = 3"));
  const auto& gates = cases[0].gates;
  BOOST_TEST_REQUIRE(gates.size() == 3u);
  BOOST_TEST(gates[2].engines == std::vector<std::string>{"core:rkmk4"});
  BOOST_TEST(gates[2].order()->is_declared);
  BOOST_TEST(cases[1].gates.size() == 2u);
}

BOOST_AUTO_TEST_CASE(errors_of_a_family_have_their_place) {
  const std::string file = (path / "suite/swings/family.toml").string();
  const std::vector<Refusal> rows = {
      {"title = 'x'", "1:1: title: unknown key", {"gate"}},
      {"", "1:1: gate: missing", {}},
      {gate("max = 1\nscene = ['sprng']"), "5:10: gate.scene[0]: ", {"did you mean 'spring'?"}},
      {gate("max = 1\nscene = ['!contact:box-pane']"), "5:10: gate.scene[0]: ", {"did you mean 'contact:box-plane'?"}},
      {gate("max = 1\ntruth = 'projectil'"), "5:9: gate.truth: ", {"did you mean 'projectile'?"}},
      {gate("max = 1\nengines = 'order>=40'"), "5:11: gate.engines: ", {"selects no run"}},
      {gate("max = 1\nexcept = ['fre']"), "5:11: gate.except[0]: ", {"did you mean 'free'?"}},
      {gate("regression = 1"), "4:14: gate.regression: ", {"above 1"}},
      {gate("at_least_order = 'declred'"), "4:18: gate.at_least_order: ", {"'declared'"}},
      {gate("max = 1\ndt = '=<1/30'"), "5:6: gate.dt: ", {"<=, >, >="}},
      {gate("max = 1\nregression = 2"), "1:1: gate: ", {"do not go together"}},
      {gate("max = 1\nmetric = 'x'"), "5:10: is not TOML", {}},
  };
  for (const Refusal& row : rows) check_refusal(row, file, [&] { cases_with(row.text); });
}

BOOST_AUTO_TEST_CASE(a_family_is_no_case_however_it_is_named) {
  cases_with(gate("max = 1"));
  const std::string file = (path / "suite/swings/family.toml").string();
  BOOST_TEST(suite_ids((path / "suite").string()) == (std::vector<std::string>{"swings/free", "swings/sprung"}));
  BOOST_TEST(refusal_of([&] {
               select_cases({file}, (path / "suite").string(), test::words());
             }).find("is none itself") != std::string::npos);
  BOOST_TEST(select_cases({(path / "suite/swings").string()}, "", test::words()).size() == 2u);
}

// Where a family stands that is no family of the suite: a folder of someone's own.
BOOST_AUTO_TEST_CASE(a_folder_elsewhere_may_have_one_too) {
  write("own/a.toml", kCase);
  write("own/family.toml", gate("max = 1"));
  BOOST_TEST(select_cases({(path / "own/a.toml").string()}, "", test::words()).front().gates.size() == 1u);
}

BOOST_AUTO_TEST_CASE(every_gate_of_a_shipped_family_is_about_some_case) {
  // "springs/family.toml:3:1", from wherever the path begins.
  const auto in_folder = [](const std::string& where) {
    const std::size_t file = where.rfind('/'), folder = file == 0 ? file : where.rfind('/', file - 1);
    return where.substr(folder == std::string::npos ? 0 : folder + 1);
  };
  std::set<std::string> met;
  for (const Case& c : select_cases({}, default_suite_dir(), test::words())) {
    for (const Gate& gate : c.gates) met.insert(in_folder(gate.where) + gate.metric);
  }
  for (const auto& entry : std::filesystem::directory_iterator(default_suite_dir())) {
    const auto file = entry.path() / kFamilyFile;
    if (!std::filesystem::exists(file)) continue;
    for (const GateTable& table : read_family(file.string(), test::words()).gates) {
      const std::string& where = table.gate.where;
      for (const std::string& metric : table.metrics)
        BOOST_TEST(met.contains(in_folder(where) + metric), where << ", " << metric);
    }
  }
}

BOOST_AUTO_TEST_SUITE_END()
