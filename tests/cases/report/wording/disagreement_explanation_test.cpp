// Engines that disagree where no truth is known: who stands apart, and who must not be said to.
#include "cases/report/wording/explanations/disagreement_explanation.h"

#include <boost/test/unit_test.hpp>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_disagreement_explanation)

namespace {

const StepSize kFine{1e-3, "1/1000"}, kCoarse{1.0 / 30, "1/30"};

// One run of each engine, with the distances of each pair at the fine step.
struct Made {
  Results results;

  explicit Made(const std::vector<std::string>& engines) {
    results.cases.emplace_back();
    results.cases[0].definition.id = "a/case";
    results.cases[0].definition.scene.bodies.emplace_back().name = "trunk";
    for (std::size_t run = 0; run < engines.size(); ++run) {
      RunName name;
      name.engine = name.text = engines[run];
      results.runs.push_back(name);
      for (const StepSize& dt : {kCoarse, kFine}) {
        Cell cell;
        cell.run = run, cell.dt = dt, cell.status = Status::pass, cell.metrics["survival"] = {};
        results.cases[0].cells.push_back(cell);
      }
    }
  }
  void put(std::size_t a, std::size_t b, double distance, const StepSize& dt = kFine) {
    Spread spread;
    spread.first = a, spread.second = b, spread.dt = dt;
    spread.distance = {.value = distance, .time = 4, .body = 0};
    results.cases[0].spreads.push_back(spread);
  }
  std::string said() const {
    std::string text;
    for (const Message& message : disagreement_explanations(results, results.cases[0])) text += message.text;
    return text;
  }
};

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Made one_apart() {
  Made made({"bullet", "dart", "mujoco", "ode"});
  made.put(0, 1, 1.5), made.put(0, 2, 1.52), made.put(0, 3, 1.51);
  made.put(1, 2, 0.03), made.put(1, 3, 0.002), made.put(2, 3, 0.031);
  for (std::size_t a = 0; a < 4; ++a)
    for (std::size_t b = a + 1; b < 4; ++b) made.put(a, b, 7, kCoarse);  // the coarse step decides nothing
  return made;
}

}  // namespace

// MuJoCo 3 has the formulas of MuJoCo: that both agree says nothing against a third.
BOOST_AUTO_TEST_CASE(two_engines_of_the_same_formulas_outvote_no_other) {
  Made made({"core", "mujoco", "mujoco3"});
  made.put(0, 1, 0.02), made.put(0, 2, 0.02), made.put(1, 2, 1e-15);
  BOOST_TEST(!has(made.said(), "stands apart"), made.said());
  BOOST_TEST(has(made.said(), "3 engines are up to 20 mm apart"), made.said());
  // But both stand apart where two others agree.
  Made four({"core", "mujoco", "mujoco3", "ode"});
  four.put(0, 1, 0.5), four.put(0, 2, 0.5), four.put(1, 2, 1e-15);
  four.put(0, 3, 1e-3), four.put(1, 3, 0.5), four.put(2, 3, 0.5);
  BOOST_TEST(has(four.said(), "mujoco stands apart: it is 500 mm from the nearest other, core"), four.said());
  BOOST_TEST(has(four.said(), "mujoco3 stands apart"), four.said());
}

// What a smaller step still changes, against what parts the engines.
BOOST_AUTO_TEST_CASE(the_steps_own_change_is_said) {
  const auto with_own = [](double of_first, double of_second) {
    Made made({"mujoco", "ode"});
    made.put(0, 1, 0.2);
    made.put(0, 0, of_first, kCoarse), made.put(1, 1, of_second, kCoarse);
    return made.said();
  };
  const std::string alike = with_own(0.003, 0.001);
  BOOST_TEST(has(alike, "From dt = 1/30 s to that step, positions still change: mujoco 3 mm, ode 1 mm."), alike);
  BOOST_TEST(has(alike, "A smaller step will not bring the engines together"), alike);
  BOOST_TEST(!has(with_own(0.003, 0.05), "will not bring"));
  Made one_only({"mujoco", "ode"});
  one_only.put(0, 1, 0.2), one_only.put(0, 0, 0.003, kCoarse);
  BOOST_TEST(has(one_only.said(), "still change: mujoco 3 mm."));
  BOOST_TEST(!has(one_only.said(), "will not bring"));  // the other's change is not known

  // Steps close to each other change little, and leave 24 times as much.
  const StepSize near{1.04e-3, "1/960"};
  Made close({"mujoco", "ode"});
  for (std::size_t run : {0u, 1u}) {
    Cell cell;
    cell.run = run, cell.dt = near, cell.status = Status::pass, cell.metrics["survival"] = {};
    close.results.cases[0].cells.push_back(cell);
    close.put(run, run, 0.003, near);
  }
  close.put(0, 1, 0.2);
  BOOST_TEST(has(close.said(), "From dt = 1/960 s to that step, positions still change: mujoco 3 mm, ode 3 mm."));
  BOOST_TEST(!has(close.said(), "will not bring"));

  // Nothing is said of a run with a still finer step, which is the one that its change goes to.
  Made finer({"mujoco", "ode"});
  finer.put(0, 1, 0.2), finer.put(0, 0, 0.003, kCoarse), finer.put(1, 1, 0.001, kCoarse);
  Cell beyond;
  beyond.run = 0, beyond.dt = {1e-4, "1/10000"}, beyond.status = Status::diverged;
  finer.results.cases[0].cells.push_back(beyond);
  BOOST_TEST(has(finer.said(), "still change: ode 1 mm."), finer.said());

  Made at_rest({"mujoco", "ode"});
  at_rest.put(0, 1, 0);
  BOOST_TEST(has(at_rest.said(), "2 engines keep every body at the same places"), at_rest.said());
}

BOOST_AUTO_TEST_CASE(an_engine_far_from_all_others_is_named) {
  const std::string said = one_apart().said();
  BOOST_TEST(
      said ==
      "No truth says who is right. At dt = 1/1000 s bullet stands apart: it is 1.5 m from the nearest other, dart "
      "('trunk', after 4 s). The others are within 31 mm of each other: dart, mujoco, ode.");
}

// Two that agree, and two that disagree with everyone: nobody is the odd one out.
BOOST_AUTO_TEST_CASE(engines_that_all_disagree_are_only_told_apart) {
  Made made({"bullet", "dart", "mujoco", "ode"});
  made.put(0, 1, 1.5), made.put(0, 2, 1.2), made.put(0, 3, 0.9);
  made.put(1, 2, 0.7), made.put(1, 3, 0.8), made.put(2, 3, 1.1);
  BOOST_TEST(has(made.said(), "4 engines are up to 1.5 m apart: most bullet and dart"));
  BOOST_TEST(!has(made.said(), "stands apart"));
}

// Two pairs: each engine has a neighbour, and a majority would be a guess.
BOOST_AUTO_TEST_CASE(two_camps_are_no_odd_one_out) {
  Made made({"bullet", "dart", "mujoco", "ode"});
  made.put(0, 1, 0.01), made.put(2, 3, 0.01);
  for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{0, 2}, {0, 3}, {1, 2}, {1, 3}}) made.put(a, b, 2);
  BOOST_TEST(has(made.said(), "4 engines are up to 2 m apart"));
  BOOST_TEST(!has(made.said(), "stands apart"));
}

BOOST_AUTO_TEST_CASE(two_engines_have_no_odd_one_out_and_one_has_nobody_to_differ_from) {
  Made two({"bullet", "dart"});
  two.put(0, 1, 1.5);
  BOOST_TEST(has(two.said(), "2 engines are up to 1.5 m apart: most bullet and dart"));
  BOOST_TEST(Made({"bullet"}).said() == "");
}

// A second run of an engine would outvote the others; a run that blew up says nothing about the rest.
BOOST_AUTO_TEST_CASE(each_engine_counts_once_and_a_lost_run_not_at_all) {
  Made made = one_apart();
  made.results.runs[1].engine = "bullet";  // now only bullet, mujoco and ode are compared
  BOOST_TEST(has(made.said(), "bullet stands apart: it is 1.5 m from the nearest other, ode"));
  BOOST_TEST(!has(made.said(), "dart"));
  made = one_apart();
  for (Cell& cell : made.results.cases[0].cells)
    if (cell.run == 0) cell.stability.verdict = Verdict::blown_up;
  BOOST_TEST(has(made.said(), "mujoco stands apart: it is 30 mm from the nearest other, dart"));
}

BOOST_AUTO_TEST_CASE(a_case_with_a_truth_needs_no_majority) {
  Made made = one_apart();
  made.results.cases[0].truth = TruthFacts{}, made.results.cases[0].definition.truth = "events";
  BOOST_TEST(made.said() == "");
  made.results.cases[0].definition.truth = "none";  // which has its facts, too
  BOOST_TEST(has(made.said(), "stands apart"));
}

BOOST_AUTO_TEST_SUITE_END()
