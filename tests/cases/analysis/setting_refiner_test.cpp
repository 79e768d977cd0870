// Numbers between the tried values of an option, where no tried value keeps a bound.
#include <boost/test/unit_test.hpp>
#include <cmath>

#include "cases/analysis/tuning/setting_chooser.h"
#include "cases/analysis/tuning/setting_refiner.h"
#include "tests/cases/runner/faulty_engine.h"

using namespace rigor;

namespace cases_analysis_setting_refiner {

// A step moves the body by `push`, and by `late` more beyond 0.2 m.
class PushedEngine : public FaultyEngine {
 public:
  PushedEngine() : FaultyEngine("pushed", [this](double& x) { x += push_ + (x > 0.2 ? late_ : 0); }) {}
  EngineInfo info() const override {
    EngineInfo info = FaultyEngine::info();
    info.methods[0].options = {{"push", "m"}, {"late", "m"}};
    for (OptionInfo& option : info.methods[0].options) option.max = 1;
    return info;
  }
  std::unique_ptr<World> load(const Scene& scene, const Settings& settings) const override {
    const auto value = [&](const char* name) {
      const auto found = settings.options.find(name);
      return found == settings.options.end() ? 0.0 : std::stod(found->second);
    };
    push_ = value("push"), late_ = value("late");
    return FaultyEngine::load(scene, settings);
  }

 private:
  mutable double push_ = 0, late_ = 0;  // m
};

struct Fixture {
  Fixture() {
    table.add(std::make_unique<PushedEngine>());
    cases = {drifting_body("a")};
    cases[0].truth = "projectile";
    cases[0].scene.bodies[0].velocity = Vec3(0.7, 0, 0);
  }
  EngineTable table;
  std::vector<Case> cases;
  TuneOptions options;
};

}  // namespace cases_analysis_setting_refiner

BOOST_FIXTURE_TEST_SUITE(cases_analysis_setting_refiner, Fixture)

BOOST_AUTO_TEST_CASE(a_number_is_searched_between_the_tried_values_beside_it) {
  const RunName run = parse_run_name("pushed,push=0.01", table.infos());
  const auto numbers = refined_numbers(run, table.infos().front().methods[0].options);
  BOOST_TEST_REQUIRE(numbers.size() == 1u);
  BOOST_TEST(numbers[0].low == 1e-4);
  BOOST_TEST(numbers[0].high == 0.1);
  BOOST_TEST(numbers[0].is_logarithmic);
  BOOST_TEST(numbers[0].share_of(0.01) == 2.0 / 3, boost::test_tools::tolerance(1e-12));
  BOOST_TEST(std::stod(numbers[0].at(numbers[0].share_of(0.0123))) == 0.0123, boost::test_tools::tolerance(1e-12));
  const RunName at_end = parse_run_name("pushed,push=0", table.infos());
  const auto from_zero = refined_numbers(at_end, table.infos().front().methods[0].options);
  BOOST_TEST_REQUIRE(from_zero.size() == 1u);
  BOOST_TEST(from_zero[0].low == 0);
  BOOST_TEST(!from_zero[0].is_logarithmic);
}

// The body moves by 0.7 m/s, so a step of 1/N s takes a push of 0.7/N, which is no tried value at any tried step.
BOOST_AUTO_TEST_CASE(a_bound_that_no_tried_value_keeps_is_kept_between_them) {
  const Tuning found = tune("pushed", cases, {{"position_error", 1e-3, "1mm"}}, table, options);
  BOOST_TEST_REQUIRE(found.winner.has_value(), found.nearest);
  BOOST_TEST(found.is_refined);
  BOOST_TEST(found.winner->error <= 1);
  BOOST_TEST(found.winner->cost > 0);
  const RunName run = parse_run_name(found.winner->run.text, table.infos());
  const double push = std::stod(run.settings.options.at("push"));
  const double steps = std::round(0.5 / found.winner->dt.seconds);
  BOOST_TEST(std::abs(steps * push - 0.35) <= 1e-3, found.winner->run.text << " at " << found.winner->dt.text);
}

// A push moves the body forward alone, so nothing reaches a body that moves back.
BOOST_AUTO_TEST_CASE(a_bound_that_nothing_keeps_is_still_refused) {
  cases[0].scene.bodies[0].velocity = Vec3(-0.7, 0, 0);
  const Tuning found = tune("pushed", cases, {{"position_error", 1e-3, "1mm"}}, table, options);
  BOOST_TEST(!found.winner.has_value());
  BOOST_TEST(!found.is_refined);
  BOOST_TEST(found.nearest.find("times the bound") != std::string::npos, found.nearest);
}

// In the first quarter of the run nothing is beyond 0.2 m.
BOOST_AUTO_TEST_CASE(an_option_that_matters_late_is_no_option_without_effect) {
  cases[0].scene.bodies[0].position = Vec3(0.1, 0, 0);
  const std::vector<Bound> bounds = {{"position_error", 1, "1m"}};
  Prober prober{cases, bounds, table, options};
  SettingChooser chooser{prober, options};
  MethodSpace space = method_spaces("pushed,push=0.01", table.infos()).front();
  const auto runs = chooser.settings_of(space, 200);
  BOOST_TEST(chooser.without_effect().empty());
  BOOST_TEST(runs.size() > 1u);
}

BOOST_AUTO_TEST_SUITE_END()
