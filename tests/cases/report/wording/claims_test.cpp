// That every number and comparison of every message follows from the results: recomputed by an oracle of its own, over
// generated results and over real runs.
#include <fmt/format.h>

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <map>
#include <random>

#include "cases/case/selection.h"
#include "cases/case/suite.h"
#include "cases/report/wording/comparison.h"
#include "cases/report/wording/explanations/explanation.h"
#include "cases/report/wording/findings/findings.h"
#include "cases/runner/grid.h"
#include "tests/cases/report/sample_results.h"
#include "tests/cases/report/wording/claim_oracle.h"
#include "tests/cases/vocabulary.h"
#include "tests/scenes.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_claims)

namespace {

class Generator {
 public:
  explicit Generator(unsigned seed) : random_(seed) {}

  Results results() {
    Results grid;
    grid.engines = engines().infos();
    for (const char* name : {"ode", "ode:quickstep", "bullet@stock", "core:dormand-prince", "core:rk4",
                             "core:explicit-euler", "core:semi-implicit-euler", "core:velocity-verlet"}) {
      if (chance(0.85)) grid.runs.push_back(parse_run_name(name, grid.engines));
    }
    if (grid.runs.empty()) grid.runs.push_back(parse_run_name("ode", grid.engines));
    const int cases = 1 + static_cast<int>(random_() % 5);
    for (int i = 0; i < cases; ++i) grid.cases.push_back(case_result(grid, i));
    return grid;
  }

 private:
  double uniform(double from, double to) { return std::uniform_real_distribution<>(from, to)(random_); }
  double spread(double from, double to) { return std::exp(uniform(std::log(from), std::log(to))); }
  bool chance(double share) { return uniform(0, 1) < share; }
  Vec3 vector(double size) { return {uniform(-size, size), uniform(-size, size), uniform(-size, size)}; }
  Quat turn() { return Quat(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(0.1, 1)).normalized(); }

  // No two moments, places or stiffnesses alike.
  Scene scene() {
    Scene scene;
    if (chance(0.7)) scene.gravity = {0, -9.81, 0};
    const int bodies = 1 + static_cast<int>(random_() % 4);
    for (int i = 0; i < bodies; ++i) {
      const double moment = spread(0.05, 2);
      Body body = test::body(fmt::format("body{}", i), spread(0.5, 40), {moment, 1.2 * moment, 1.4 * moment},
                             {1.5 * i, uniform(-1, 1), uniform(-1, 1)});
      body.orientation = turn();
      scene.bodies.push_back(body);
    }
    const double way = uniform(0, 1);
    if (way < 0.45) add_springs(scene);
    if (way > 0.3 && way < 0.9) add_joints(scene);
    return scene;
  }

  void add_springs(Scene& scene) {
    for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
      const int a = i == 0 ? kWorld : i - 1;
      const Vec3 from = a == kWorld ? Vec3(uniform(-3, -1), 2, 0) : vector(0.3);
      scene.springs.push_back(
          test::spring(a, from, i, vector(0.3), spread(1, 1e5), 1, chance(0.3) ? spread(1, 3000) : 0));
    }
  }

  void add_joints(Scene& scene) {
    for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
      const Vec3 anchor = scene.bodies[static_cast<std::size_t>(i)].position + vector(0.5),
                 axis = vector(1).normalized();
      Joint joint{.a = i == 0 ? kWorld : i - 1, .b = i, .type = BallJoint{anchor}};
      const double kind = uniform(0, 1);
      if (kind < 0.5) joint.type = HingeJoint{anchor, axis};
      if (kind > 0.8) joint.type = SliderJoint{axis};
      if (kind < 0.5 || kind > 0.8) {
        if (chance(0.5)) joint.damping = spread(0.1, 3000);
        if (chance(0.4)) joint.stiffness = spread(1, 1e5);
      }
      scene.joints.push_back(joint);
    }
  }

  MetricValue metric(double low, double high) {
    const double value = spread(low, high);
    MetricValue made = sample_metric(value, {0.3, kWorld, "a component", chance(0.5) ? 10.0 : 20.0, 15});
    made.first_second = value * uniform(0.05, 1);
    return made;
  }

  void fill_metrics(Cell& cell, const CaseResult& result) {
    auto& metrics = cell.metrics;
    const double finer = std::pow(cell.dt.seconds * 30, uniform(0.5, 3));
    metrics["cost"] = metric(1e-5 / cell.dt.seconds, 1e-4 / cell.dt.seconds);
    for (const char* name : {"position_error", "orientation_error"}) {
      metrics[name] = metric(1e-3 * finer, 10 * finer);
      if (chance(0.05)) metrics[name].is_held_to_itself = true;
    }
    if (result.definition.scene.springs.empty() && chance(0.2))
      metrics["position_error"].first_second =
          0.5 * result.definition.scene.gravity.norm() * cell.dt.seconds * uniform(0.992, 1.008);
    metrics["energy_drift"] = metric(1e-4, 2), metrics["energy_drift_synchronised"] = metric(1e-4, 2);
    metrics["orthonormality_error"] = chance(0.3) ? metric(0.2, 5) : metric(1e-16, 1e-14);
    if (!result.definition.scene.joints.empty()) metrics["joint_gap"] = metric(1e-7, 0.1);
    if (chance(0.4)) metrics["friction_anisotropy"] = metric(0.01, 0.4);
    if (chance(0.4)) {
      metrics["restitution_error"] = metric(0.01, 0.9);
      metrics["restitution_error"].worst = {0.3, 0, "restitution", spread(0.01, 0.9), chance(0.5) ? 0.0 : 1.0};
    }
    if (result.definition.ensemble > 0)
      metrics["ensemble_distance"] = metric(0.01, 1), metrics["ensemble_p_value"] = metric(1e-3, 1);
  }

  void fill_scheme(Cell& cell) {
    cell.scheme.twin = "core:semi-implicit-euler";
    cell.metrics["unexplained_error"] = metric(1e-14, 1e-3);
    for (const char* name : {"energy_drift", "angular_momentum_drift"}) {
      cell.scheme.metrics[name] = metric(1e-4, 2);
      cell.scheme.without_gyroscopic_term[name] = metric(1e-6, 1);
    }
    if (chance(0.5)) cell.scheme.metrics["energy_drift"] = cell.metrics["energy_drift"];
  }

  Cell cell(const Results& grid, const CaseResult& result, std::size_t run, const StepSize& dt) {
    Cell cell;
    cell.run = run, cell.dt = dt, cell.status = Status::pass, cell.reason = "";
    const double fate = uniform(0, 1);
    if (fate < 0.05) {
      cell.status = chance(0.5) ? Status::crashed : Status::unsupported, cell.reason = "some reason";
      return cell;
    }
    fill_metrics(cell, result);
    if (grid.runs[run].engine != "core" && chance(0.7)) fill_scheme(cell);
    cell.settings = {{"erp", "0.2: of a gap"}, {"friction", "a pyramid"}, {"restitution", "across a gap"}};
    if (chance(0.5)) cell.settings.emplace_back("iterations", "20");
    if (fate < 0.3) {
      cell.status = Status::diverged;
      cell.stability = {Verdict::blown_up, uniform(0.5, 5), 0, "grew"};
    } else if (fate < 0.6) {
      cell.stability = {chance(0.7) ? Verdict::drifting : Verdict::gaining, 1, kWorld, "the energy moved", 0.1};
    }
    return cell;
  }

  CaseResult case_result(const Results& grid, int index) {
    CaseResult result;
    result.definition.id = fmt::format("family/case-{}", static_cast<char>('a' + index));
    result.definition.scene = scene();
    result.definition.duration = 5;
    result.definition.dt = {{1.0 / 30, "1/30"}, {1.0 / 240, "1/240"}, {1.0 / 1000, "1/1000"}};
    result.definition.ensemble = chance(0.3) ? 50 : 0;
    result.truth = TruthFacts{1e-12, 5, 50};
    for (std::size_t run = 0; run < grid.runs.size(); ++run) {
      for (const StepSize& dt : result.definition.dt) result.cells.push_back(cell(grid, result, run, dt));
      result.stable_steps.push_back({Status::pass, "", {0.06, false, false, chance(0.3) ? "cut" : ""}});
    }
    return result;
  }

  std::mt19937 random_;
};

void count_topics(const Results& grid, std::map<std::string, int>& topics) {
  for (const Finding& finding : findings(grid)) ++topics["finding: " + finding.topic];
  for (const CaseResult& result : grid.cases) {
    for (const Message& message : explanations(grid, result)) ++topics[message.topic];
    topics["equal cost"] += static_cast<int>(work_precision_messages(grid, result).size());
  }
}

// Cases of the suite with these runs, at their coarsest step.
Results ran(const std::vector<std::string>& cases, const std::vector<std::string>& names) {
  std::vector<Case> chosen = select_cases(cases, default_suite_dir(), test::words());
  std::vector<RunName> runs;
  for (const std::string& name : names) runs.push_back(parse_run_name(name, engines().infos()));
  for (Case& one : chosen) {
    const StepSize coarsest = *std::max_element(one.dt.begin(), one.dt.end(),
                                                [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
    one.dt = {coarsest}, one.gates.clear();
  }
  Results grid = plan_grid(chosen, runs, engines(), {false});
  GridOptions options;
  options.jobs = 2, options.stable_steps = false;
  run_grid(grid, engines(), options, [](std::size_t, std::size_t) {});
  return grid;
}

}  // namespace

BOOST_AUTO_TEST_CASE(each_number_and_comparison_follows_from_generated_results) {
  std::map<std::string, int> topics;
  for (unsigned seed = 1; seed <= 150; ++seed) {
    const Results grid = Generator(seed).results();
    count_topics(grid, topics);
    BOOST_TEST_CONTEXT("seed " << seed) {
      for (const std::string& error : test::errors_of_all_messages(grid)) BOOST_TEST(error == "");
    }
  }
  for (const char* topic : {"finding: stability",
                            "finding: stiff springs",
                            "finding: step size",
                            "finding: energy",
                            "finding: friction",
                            "finding: impacts",
                            "finding: joints",
                            "finding: sampling",
                            "finding: unexplained",
                            "damper",
                            "spring",
                            "orientation",
                            "blow-up",
                            "fall",
                            "sampling",
                            "gyroscopic term",
                            "stable step",
                            "verdict",
                            "restitution",
                            "overlap",
                            "friction",
                            "joint gap",
                            "ensemble",
                            "equal cost"})
    BOOST_TEST(topics[topic] > 0, topic);
}

// A message that states something else is found out: each claim's value, each comparison, each number of the text.
BOOST_AUTO_TEST_CASE(the_oracle_finds_a_wrong_value_a_wrong_comparison_and_a_number_without_a_claim) {
  const Results grid = Generator(7).results();
  std::vector<Message> all = findings(grid);
  for (const CaseResult& result : grid.cases) {
    for (Message& message : explanations(grid, result)) all.push_back(std::move(message));
  }
  int changed = 0;
  for (const Message& message : all) {
    BOOST_TEST(test::errors_of(grid, message).empty());
    for (std::size_t n = 0; n < message.claims.size(); ++n) {
      Message wrong = message;
      if (wrong.claims[n].quantity == "energy growth") continue;  // of few schemes a formula is at hand
      wrong.claims[n].value = 1.5 * wrong.claims[n].value + 1;
      BOOST_TEST(!test::errors_of(grid, wrong).empty(), wrong.claims[n].quantity);
      ++changed;
      if (message.claims[n].relation != Relation::above) continue;
      wrong = message, wrong.claims[n].bound = 2 * wrong.claims[n].value;
      BOOST_TEST(!test::errors_of(grid, wrong).empty(), wrong.claims[n].quantity);
    }
    Message longer = message;
    longer.text += " It takes 731 s.";
    BOOST_TEST(!test::errors_of(grid, longer).empty());
  }
  BOOST_TEST(changed > 20);
}

// The whole suite, with every engine, by RIGOR_CLAIMS=all; else a few cases of each kind.
BOOST_AUTO_TEST_CASE(each_number_and_comparison_follows_from_real_runs) {
  const bool is_all = std::getenv("RIGOR_CLAIMS") && std::string(std::getenv("RIGOR_CLAIMS")) == "all";
  const std::vector<std::string> cases =
      is_all ? std::vector<std::string>{}
             : std::vector<std::string>{"ballistic/projectile", "springs/stiff-1.8", "springs/stiff-3",
                                        "springs/hung-part",    "joints/chain-10",   "joints/pendulum-small",
                                        "tops/needle",          "tops/small-top"};
  const std::vector<std::string> runs = {"ode", "core:explicit-euler", "core:semi-implicit-euler", "core:rk4",
                                         "core:adams"};
  for (const std::string& error : test::errors_of_all_messages(ran(cases, runs))) BOOST_TEST(error == "");
}

BOOST_AUTO_TEST_SUITE_END()
