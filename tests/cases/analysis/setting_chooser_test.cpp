// What a tuning takes for settings: values that change something and do not make the run far dearer.
#include <sys/resource.h>

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <ctime>
#include <set>

#include "cases/analysis/tuning/setting_chooser.h"
#include "tests/cases/runner/faulty_engine.h"

using namespace rigor;

namespace cases_analysis_setting_chooser {

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

double cpu_seconds_of_children() {
  rusage used{};
  getrusage(RUSAGE_CHILDREN, &used);
  return static_cast<double>(used.ru_utime.tv_sec) + 1e-6 * static_cast<double>(used.ru_utime.tv_usec);
}

// A step moves the body by `push` and takes `work` µs; `idle` does nothing.
class PricedEngine : public FaultyEngine {
 public:
  PricedEngine() : FaultyEngine("priced", [this](double& x) { work(), x += push_; }) {}
  EngineInfo info() const override {
    EngineInfo info = FaultyEngine::info();
    info.methods[0].options = {{"push", "m"}, {"work", "µs"}, {"idle", "nothing"}};
    for (OptionInfo& option : info.methods[0].options) option.max = 1;
    info.methods[0].options[1].choices = {"100", "1000000"};
    return info;
  }
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override {
    const auto value = [&](const char* name, double otherwise) {
      const auto found = settings.options.find(name);
      return found == settings.options.end() ? otherwise : std::stod(found->second);
    };
    push_ = value("push", 0) + 1e-6 * value("work", 0), work_ = value("work", 0);
    return FaultyEngine::load(scene, settings);
  }

 private:
  void work() const {
    for (const double begin = cpu_seconds(); cpu_seconds() - begin < 1e-6 * work_;) {
    }
  }
  mutable double push_ = 0, work_ = 0;
};

struct Fixture {
  Fixture() {
    table.add(std::make_unique<PricedEngine>());
    cases = {drifting_body("a")};
    cases[0].truth = "projectile";
  }
  std::vector<std::string> settings(std::size_t most) {
    return chooser.settings_of(method_spaces("priced", infos_of(table)).front(), most);
  }
  EngineTable table;
  std::vector<Case> cases;
  std::vector<Bound> bounds = {{"position_error", 1, "1m"}};
  TuneOptions options;
  Prober prober{cases, bounds, table, options};
  SettingChooser chooser{prober, options};
};

bool has(const std::vector<std::string>& runs, const std::string& part) {
  return std::any_of(runs.begin(), runs.end(), [&](const auto& run) { return run.find(part) != std::string::npos; });
}

}  // namespace cases_analysis_setting_chooser

BOOST_FIXTURE_TEST_SUITE(cases_analysis_setting_chooser, Fixture)

BOOST_AUTO_TEST_CASE(what_is_without_effect_or_far_dearer_is_left_out) {
  const double before = cpu_seconds_of_children();
  const auto runs = settings(200);
  BOOST_TEST(runs.front() == "priced");
  BOOST_TEST(has(runs, "push=0.4"));
  BOOST_TEST(has(runs, "work=100"));
  BOOST_TEST(!has(runs, "work=1000000"));
  BOOST_TEST(!has(runs, "idle"));
  BOOST_TEST(chooser.without_effect() == std::vector<std::string>{"idle of priced"}, boost::test_tools::per_element());
  // 1 s a step would be 16 s in all; it is given up after kLeastLimit at each of the two steps.
  BOOST_TEST(cpu_seconds_of_children() - before < 10);
}

// All combinations if they fit; else each value by itself, and then combinations that the seed draws.
BOOST_AUTO_TEST_CASE(the_full_grid_is_taken_only_if_all_of_it_fits) {
  const std::vector<std::string> grid = settings(200);
  const auto pushes =
      std::count_if(grid.begin(), grid.end(), [](const auto& run) { return run.find("work") == std::string::npos; });
  BOOST_TEST(grid.size() == 2 * static_cast<std::size_t>(pushes));  // with `work=100`, and without
  BOOST_TEST(grid.size() >= 8u);
  BOOST_TEST(settings(grid.size()) == grid, boost::test_tools::per_element());
  std::set<std::vector<std::string>> drawn;
  for (options.seed = 1; options.seed <= 3; ++options.seed) {
    drawn.insert(settings(grid.size() - 1));
    for (const std::string& run : *drawn.begin()) BOOST_TEST(has(grid, run));
  }
  BOOST_TEST(drawn.size() > 1u);
}

BOOST_AUTO_TEST_CASE(where_no_other_setting_has_room_none_is_run) {
  BOOST_TEST(settings(1).size() == 1u);
  BOOST_TEST(prober.runs() == 0u);
}

BOOST_AUTO_TEST_SUITE_END()
