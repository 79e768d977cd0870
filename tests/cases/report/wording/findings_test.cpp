#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/recommendation.h"

#include <fmt/format.h>

#include <boost/test/unit_test.hpp>

#include "cases/report/json/frontier_json.h"
#include "cases/report/wording/verdict_matrix.h"
#include "cases/results/main_error.h"
#include "tests/cases/priced_results.h"
#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_findings)

namespace {

bool has(const std::vector<Finding>& found, const std::string& part) {
  return std::any_of(found.begin(), found.end(),
                     [&](const Finding& f) { return (f.text + " | " + f.more).find(part) != std::string::npos; });
}

std::string all(const std::vector<Finding>& found) {
  std::string text;
  for (const Finding& finding : found) text += finding.topic + ": " + finding.text + " | " + finding.more + "\n";
  return text;
}

// The first run drifts in its only case: from 15 J to 10 J where 100 % is 10 J, as its scheme does or does not.
Results drifting_results(double by_scheme, double without_gyroscopic_term) {
  Results grid = sample_results();
  Cell& cell = grid.cases[0].cells[0];
  cell.stability.verdict = Verdict::drifting;
  cell.metrics["energy_drift"] = sample_metric(0.5, {0.3, kWorld, "energy", 10, 15});
  cell.scheme.metrics["energy_drift"] = sample_metric(by_scheme, {0.3, kWorld, "energy", 10, 15});
  cell.scheme.without_gyroscopic_term["energy_drift"] =
      sample_metric(without_gyroscopic_term, {0.3, kWorld, "energy", 15, 15});
  return grid;
}

}  // namespace

BOOST_AUTO_TEST_CASE(who_blows_up_is_named_with_its_cases) {
  const auto sentences = findings(sample_results());
  BOOST_TEST(has(sentences,
                 "Blow-ups at dt = 1/10 s: wild in 1 of 1 case. No blow-up: good. | Blown up: wild in family/case. "),
             all(sentences));
}

BOOST_AUTO_TEST_CASE(lost_energy_is_laid_to_the_scheme_as_far_as_that_shows_it) {
  const std::string loss = "Energy loss at dt = 1/10 s: good -50 % on family/case in 0.5 s";
  const auto gyroscopic = findings(drifting_results(0.5, 0.001));
  BOOST_TEST(has(gyroscopic, loss + ", by the scheme's gyroscopic term."), all(gyroscopic));
  const auto scheme = findings(drifting_results(0.5, 0.4));
  BOOST_TEST(has(scheme, loss + ", by the scheme."), all(scheme));
  for (const auto& [by_scheme, share] : {std::pair{0.125, "25"}, {0.25, "50"}, {0.49, "98"}}) {
    const auto part = findings(drifting_results(by_scheme, 0.4));
    BOOST_TEST(has(part, fmt::format("{}, {} % of it by the scheme.", loss, share)), all(part));
  }
}

BOOST_AUTO_TEST_CASE(the_worst_case_is_told_and_not_the_mildest) {
  for (const bool worst_is_first : {true, false}) {
    Results grid = drifting_results(0.5, 0.4);
    grid.cases.push_back(grid.cases[0]);
    grid.cases[0].definition.id = worst_is_first ? "worst" : "mild";
    grid.cases[1].definition.id = worst_is_first ? "mild" : "worst";
    grid.cases[worst_is_first ? 1 : 0].cells[0].metrics["energy_drift"].value = 0.2;
    const auto found = findings(grid);
    BOOST_TEST(has(found, "good -50 % on worst in"), all(found));
    BOOST_TEST(!has(found, "-20 %"), all(found));
  }
}

BOOST_AUTO_TEST_CASE(energy_that_dampers_take_is_not_called_lost) {
  Results grid = drifting_results(0.5, 0.4);
  BOOST_TEST(has(findings(grid), "Energy loss"));
  Scene& scene = grid.cases[0].definition.scene;
  scene.springs = {{.a = kWorld, .b = 0, .point_a = Vec3(0, 1, 0), .stiffness = 1, .damping = 1}};
  BOOST_TEST(!has(findings(grid), "Energy loss"));
}

BOOST_AUTO_TEST_CASE(what_no_scheme_explains_is_the_largest_of_the_runs_that_held) {
  const auto sentences = findings(sample_results());
  // The blown-up cell has a twin too, and does not count.
  BOOST_TEST(
      has(sentences, "beside 1 run. The largest position error left unexplained is 10 mm (good on family/case)."),
      all(sentences));
}

BOOST_AUTO_TEST_CASE(friction_is_told_a_pyramid_from_a_cone_by_its_spread) {
  BOOST_TEST(!has(findings(sample_results()), "pyramid"));  // nothing slides
  Results grid = sample_results();
  grid.cases[0].cells[0].metrics["friction_anisotropy"] = sample_metric(0.293, {0.3, 0, "distance", 1.8, 2.5});
  auto sentences = findings(grid);
  BOOST_TEST(has(sentences, "(a pyramid): good (29 %). Equal in all directions (a cone): none."), all(sentences));
  grid.cases[0].cells[0].metrics["friction_anisotropy"] = sample_metric(1e-3, {0.3, 0, "distance", 2.5, 2.5});
  sentences = findings(grid);
  BOOST_TEST(has(sentences, "(a pyramid): none. Equal in all directions (a cone): good."), all(sentences));
  grid.cases[0].cells[0].metrics["friction_anisotropy"] = sample_metric(0.16, {0.3, 0, "distance", 2.9, 2.5});
  sentences = findings(grid);
  BOOST_TEST(
      has(sentences, "(a pyramid): none. Equal in all directions (a cone): none. Uneven, but no pyramid: good (16 %)."),
      all(sentences));
}

// The rule of the recommendation: only steps that were tried count.
BOOST_AUTO_TEST_CASE(the_largest_step_within_a_millimetre_is_one_that_was_tried) {
  const auto found = findings(test::priced_results({{"first", {{0.1, 4e-3, 1}, {0.05, 2e-3, 2}}},
                                                    {"fourth", {{0.1, 4e-3, 1}, {0.05, 0.25e-3, 2}}},
                                                    {"level", {{0.1, 4e-3, 1}, {0.05, 4e-3, 2}}},
                                                    {"far", {{0.1, 128e-3, 1}, {0.05, 64e-3, 2}}}}));
  BOOST_TEST(has(found, "Largest step within 1 mm: fourth 0.050000 s, first none, level none, far none."), all(found));
}

BOOST_AUTO_TEST_CASE(a_case_in_which_nothing_moves_recommends_no_step) {
  Results grid = test::priced_results({{"first", {{0.1, 0, 1}, {0.05, 0, 2}}}});
  BOOST_TEST(recommendation(grid)->text == "For 1 mm take first at 0.100000 s.");
  grid.cases[0].truth->is_still = true;
  BOOST_TEST(recommendation(grid)->text == "Nothing moves in this case, so it tells no step size.");
  BOOST_TEST(has(findings(grid), "Nothing moves in this case, so it tells no step size."), all(findings(grid)));
  BOOST_TEST(recommendation_json(grid)["external"].is_null());
  grid.cases.push_back(grid.cases[0]);
  BOOST_TEST(recommendation(grid)->text == "Nothing moves in these cases, so they tell no step size.");
  grid.cases[0].truth->is_still = false;
  BOOST_TEST(recommendation(grid)->text.starts_with("For 1 mm take first at 0.100000 s"));
  BOOST_TEST(recommendation_json(grid)["external"]["engine"] == "first");
}

// A method that blows up in one of two cases must not win. The order of a table breaks no tie.
BOOST_AUTO_TEST_CASE(a_blow_up_is_no_step_a_tie_names_both_and_a_reference_stands_apart) {
  Results grid;
  grid.engines = engines().infos();
  const std::vector<std::string> names = {"core:explicit-euler", "core:rk4", "core:velocity-verlet",
                                          "core:dormand-prince", "ode"};
  for (const std::string& name : names) grid.runs.push_back(parse_run_name(name, grid.engines));
  const std::vector<std::vector<double>> errors = {{-1, 1e-4, 1e-4, 1e-9, 5e-4}, {1e-4, 1e-4, 1e-4, 1e-9, 5e-4}};
  for (const auto& row : errors) {
    CaseResult result = sample_results().cases[0];
    result.definition.id = "case" + std::to_string(grid.cases.size()), result.cells.clear();
    for (std::size_t run = 0; run < names.size(); ++run) {
      Cell cell;
      cell.run = run, cell.dt = result.definition.dt[0], cell.status = Status::pass, cell.reason = "";
      cell.metrics["position_error"] = sample_metric(std::abs(row[run]), {});
      if (row[run] < 0) cell.status = Status::diverged, cell.stability = {Verdict::blown_up, 0.1, 0, ""};
      result.cells.push_back(cell);
    }
    result.stable_steps.assign(names.size(), {});
    grid.cases.push_back(result);
  }
  const auto found = findings(grid);
  BOOST_TEST(has(found,
                 "Largest step within 1 mm: ode 1/10 s; best of 3 core methods: core:rk4, core:velocity-verlet 1/10 s; "
                 "adaptive reference: core:dormand-prince 1/10 s."),
             all(found));
  BOOST_TEST(has(found, "core:explicit-euler none"), all(found));
}

BOOST_AUTO_TEST_CASE(stiff_springs_are_those_whose_omega_dt_is_above_one) {
  Results grid = sample_results();
  Scene& scene = grid.cases[0].definition.scene;
  // Through the centre, so omega = sqrt(k/m) rad/s; the headline is dt = 0.1 s.
  scene.springs = {{.a = kWorld, .b = 0, .point_a = Vec3(0, 1, 0)}};
  scene.bodies[0].position = Vec3::Zero();
  for (const auto& [omega_dt, is_stiff] : {std::pair{0.9, false}, {1.1, true}}) {
    scene.springs[0].stiffness = scene.bodies[0].mass * std::pow(omega_dt / 0.1, 2);
    const auto found = findings(grid);
    BOOST_TEST_CONTEXT(omega_dt) {
      BOOST_TEST(
          has(found,
              "Springs with ω dt of 1 or more at dt = 1/10 s. Stable: good. Blown up: wild in 1 of 1 case. | ") ==
              is_stiff,
          all(found));
      BOOST_TEST(has(found, "Blown up: wild. The cases: family/case.") == is_stiff, all(found));
    }
  }
}

BOOST_AUTO_TEST_CASE(a_run_that_gains_energy_on_stiff_springs_is_not_called_stable) {
  Results grid = sample_results();
  Scene& scene = grid.cases[0].definition.scene;
  scene.springs = {{.a = kWorld, .b = 0, .point_a = Vec3(0, 1, 0), .stiffness = 1e3 * scene.bodies[0].mass}};
  scene.bodies[0].position = Vec3::Zero();
  grid.cases[0].cells[0].stability.verdict = Verdict::gaining;
  const auto found = findings(grid);
  BOOST_TEST(has(found, "Stable: none. Bounded, but not stable: good."), all(found));
}

BOOST_AUTO_TEST_CASE(our_own_methods_are_counted_at_a_glance_and_named_behind_it) {
  Results grid = sample_results();
  CaseResult& result = grid.cases[0];
  const Cell fine = result.cells[0];
  grid.engines.push_back(grid.engines[0]);
  grid.engines.back().name = "core", grid.engines.back().is_in_house = true;
  for (const char* name : {"core:a", "core:b", "core:c", "core:d"}) {
    grid.runs.push_back(grid.runs[0]);
    grid.runs.back().text = name, grid.runs.back().engine = "core";
    result.cells.push_back(fine);
    result.cells.back().run = grid.runs.size() - 1;
    result.stable_steps.push_back(result.stable_steps[0]);
  }
  auto found = findings(grid);
  BOOST_TEST(has(found, "No blow-up: good, all 4 core methods. | "), all(found));
  BOOST_TEST(has(found, "Never: good, core:a, core:b, core:c, core:d."), all(found));
  result.cells.back().stability = {Verdict::blown_up, 0.4, 0, ""};
  found = findings(grid);
  BOOST_TEST(has(found, "wild, core:d in 1 of 1 case. No blow-up: good, core:a, core:b, core:c. | "), all(found));
}

BOOST_AUTO_TEST_CASE(what_contacts_do_wrong_is_told_with_its_worst_case_and_the_engines_own_reason) {
  Results grid = sample_results();
  grid.cases.push_back(grid.cases[0]);
  grid.cases.back().definition.id = "worse";
  for (std::size_t i = 0; i < 2; ++i) {
    CaseResult& result = grid.cases[i];
    BOOST_REQUIRE(result.cells[0].dt.seconds > result.cells[1].dt.seconds);
    result.cells[0].settings = result.cells[1].settings = {{"restitution", "across a gap"}, {"erp", "0.2 of it"}};
    result.cells[0].metrics["restitution_error"] = sample_metric(0.01, {0.5, 0, "restitution", 0.5, 1});
    result.cells[1].metrics["restitution_error"] = sample_metric(i ? 0.4 : 0.2, {0.5, 0, "restitution", 0.5, 1});
  }
  auto found = findings(grid);
  BOOST_TEST(
      has(found, "Restitution errors that do not fall with dt: good (worst: good on worse, 0.01 at dt = 1/10 s, 0.4"),
      all(found));
  BOOST_TEST(has(found, "good: Its setting \"restitution\": across a gap"), all(found));
  grid.cases[1].cells[1].metrics["restitution_error"] = sample_metric(7, {0.5, 0, "restitution", 8, 1});
  found = findings(grid);  // more than all of the speed: no restitution
  BOOST_TEST(has(found, "good (worst: good on family/case, 0.01 at dt = 1/10 s, 0.2 at"), all(found));
  for (CaseResult& result : grid.cases)
    result.cells[1].metrics["restitution_error"] = sample_metric(0.14, {0.5, 0, "restitution", 0.14, 0});
  found = findings(grid);
  BOOST_TEST(has(found, "Overlaps pushed out as speed: good (worst: good on family/case, 14 % of the approach speed"),
             all(found));
  BOOST_TEST(has(found, "0.2 of it"), all(found));
  BOOST_TEST(!has(found, "do not fall"), all(found));
}

BOOST_AUTO_TEST_CASE(energy_that_only_the_reading_loses_is_called_so) {
  Results grid = sample_results();
  auto& metrics = grid.cases[0].cells[0].metrics;
  metrics["energy_drift"] = sample_metric(0.034, {0.3, kWorld, "energy", 10, 15});
  metrics["energy_drift_synchronised"] = sample_metric(4e-4, {0.3, kWorld, "energy", 15, 15});
  auto found = findings(grid);
  BOOST_TEST(has(found, "sampling, at dt = 1/10 s: good 3.4 % as read, 0.04 % at one instant (family/case)."),
             all(found));
  metrics["energy_drift_synchronised"] = sample_metric(0.03, {0.3, kWorld, "energy", 10, 15});
  found = findings(grid);  // it is lost indeed
  BOOST_TEST(!has(found, "as read"), all(found));
}

BOOST_AUTO_TEST_CASE(the_headline_is_a_thirtieth_if_any_case_has_it) {
  Results grid = sample_results();
  BOOST_TEST(headline_dt(grid).text == "1/10");
  grid.cases.push_back(grid.cases.front());
  grid.cases.back().definition.dt.push_back({1.0 / 30, "1/30"});
  BOOST_TEST(headline_dt(grid).text == "1/30");
}

BOOST_AUTO_TEST_CASE(the_matrix_has_a_word_and_a_number_in_each_cell) {
  Results grid = sample_results();
  grid.cases[0].cells[3].status = Status::unsupported;
  TextTable matrix = verdict_matrix(grid);
  BOOST_TEST((matrix.rows[0] == std::vector<std::string>{"case", "good", "wild"}));
  BOOST_TEST((matrix.rows[1] == std::vector<std::string>{"family/case", "✓ stable 0.25 m ▓", "✕ blown up 0.40 s"}));
  grid.cases[0].definition.dt = {{0.05, "1/20"}};
  grid.cases.push_back(sample_results().cases.front());
  grid.cases.back().definition.id = "other";
  matrix = verdict_matrix(grid);
  BOOST_TEST(
      (matrix.rows[1] == std::vector<std::string>{"family/case (dt 1/20)", "✓ stable 0.25 m ▓", "– unsupported"}));
  matrix = verdict_matrix(grid, Words::few);
  BOOST_TEST((matrix.rows[1] == std::vector<std::string>{"family/case (dt 1/20)", "✓ 0.25 m ▓", "–"}));
}

BOOST_AUTO_TEST_CASE(a_stable_cell_that_was_stepped_in_part_at_a_lower_order_has_its_mark) {
  Results grid = sample_results();
  Cell& cell = grid.cases[0].cells[0];
  BOOST_TEST(verdict_matrix(grid).rows[1][1].starts_with("✓"));
  cell.reduced_order = ReducedOrder{0.1, "by other steps"};
  BOOST_TEST(verdict_matrix(grid).rows[1][1].starts_with("◐"));
  cell.stability.verdict = Verdict::drifting;
  BOOST_TEST(verdict_matrix(grid).rows[1][1].starts_with("≈"));
}

BOOST_AUTO_TEST_CASE(a_cells_sign_and_word_are_its_verdict_and_its_shade_is_the_decade_of_its_error) {
  // A body of 1 kg and 1 kg m² about each axis: a sphere of gyration of 2.45 m is its size.
  Results grid = sample_results();
  const auto shown = [&](const Stability& stability, double error) {
    grid.cases[0].cells[0].stability = stability;
    grid.cases[0].cells[0].metrics["position_error"].value = error;
    return verdict_matrix(grid).rows[1][1];
  };
  BOOST_TEST(size_of(grid.cases[0].definition.scene) == 2.45, boost::test_tools::tolerance(1e-3));
  BOOST_TEST(shown({Verdict::stable, 0, kWorld, ""}, 0.002) == "✓ stable 0.002 m");
  BOOST_TEST(shown({Verdict::drifting, 0, kWorld, "", 0.02}, 0.003) == "≈ drifting 0.003 m ░");
  BOOST_TEST(shown({Verdict::overlapping, 1, 0, "", 0.5}, 0.03) == "∩ overlapping 0.5 m 0.03 m ▒");
  BOOST_TEST(shown({Verdict::gaining, 1, kWorld, "", 0.132}, 0.3) == "↑ gaining 13 % 0.3 m ▓");
  BOOST_TEST(shown({Verdict::collapsed, 0.1667, 0, ""}, 2.5) == "↓ collapsed 0.17 s 2.5 m █");
  grid.cases[0].cells[0].metrics.erase("position_error");
  BOOST_TEST(shade_of(grid.cases[0], grid.cases[0].cells[0]) == " ");
  // Where nothing moves away, the angle is shown and shaded.
  for (Cell& cell : grid.cases[0].cells)
    cell.metrics["position_error"] = sample_metric(0, {}), cell.metrics["orientation_error"] = sample_metric(0.02, {});
  BOOST_TEST(shade_of(grid.cases[0], grid.cases[0].cells[0]) == "▒");
}

BOOST_AUTO_TEST_CASE(the_error_that_matters_is_the_first_that_is_there) {
  CaseResult result = sample_results().cases.front();
  BOOST_TEST(main_error(result) == "position_error");
  for (Cell& cell : result.cells) cell.metrics["position_error"] = sample_metric(0, {});
  for (Cell& cell : result.cells) cell.metrics["orientation_error"] = sample_metric(1, {});
  BOOST_TEST(main_error(result) == "orientation_error");
  for (Cell& cell : result.cells) cell.metrics.erase("position_error"), cell.metrics.erase("orientation_error");
  BOOST_TEST(main_error(result) == "energy_drift_synchronised");
}

BOOST_AUTO_TEST_SUITE_END()
