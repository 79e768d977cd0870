#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "cases/report/reports.h"
#include "cases/results/result_json.h"
#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_json_json_report)

BOOST_AUTO_TEST_CASE(a_reader_finds_every_part_by_its_name) {
  const auto json = nlohmann::json::parse(json_report(sample_results()));
  BOOST_TEST(json.at("schema") == 2);
  for (const char* key : {"cpu", "cores", "compiler", "build_type"}) BOOST_TEST(json.at("machine").contains(key), key);
  BOOST_TEST(json.at("program").contains("version"));
  const auto& one_case = json.at("cases").at(0);
  for (const char* key :
       {"id", "title", "source", "duration", "truth", "gates", "observed_order", "work_precision", "spread"})
    BOOST_TEST(one_case.contains(key), key);
  BOOST_TEST(json.at("cells").size() == 4u);
  const auto& cell = json.at("cells").at(0);
  BOOST_TEST(cell.at("case") == "family/case");
  BOOST_TEST(cell.at("engine") == "good");
  BOOST_TEST(cell.at("dt") == "1/10");
  BOOST_TEST(cell.at("dt_seconds") == 0.1);
  BOOST_TEST(cell.at("status") == "pass");
  BOOST_TEST(cell.at("verdict").at("word") == "stable");
  BOOST_TEST(cell.at("verdict").at("phrase") == "stable");
  BOOST_TEST(json.at("cases").at(0).at("size").get<double>() == 2.45, boost::test_tools::tolerance(1e-3));
  BOOST_TEST(cell.at("settings").at("solver") == "exact");
  BOOST_TEST(cell.at("trajectory") == "t0.csv");
  const auto& error = cell.at("metrics").at("position_error");
  BOOST_TEST(error.at("value") == 0.25);
  BOOST_TEST(error.at("unit") == "m");
  BOOST_TEST(error.at("compared_until") == 0.5);
  BOOST_TEST(error.at("worst").at("time") == 0.3);
  BOOST_TEST(error.at("worst").at("body") == "st|one \"1\", <i>");
  BOOST_TEST(error.at("worst").at("component") == "position.y");
  BOOST_TEST(error.at("worst").at("found") == 2);
  BOOST_TEST(error.at("worst").at("expected") == 1.75);
  BOOST_TEST(cell.at("metrics").at("energy_drift").at("worst").at("body") == "world");
  BOOST_TEST(cell.at("metrics").at("orientation_error").at("not_applicable") == "nothing turns");
  BOOST_TEST(json.at("stable_dt").at(0).at("dt") == 0.0678);
  BOOST_TEST(json.at("stable_dt").at(1).at("dt").is_null());
}

BOOST_AUTO_TEST_CASE(what_is_not_finite_has_a_word_and_what_is_not_text_is_no_trouble) {
  const auto json = nlohmann::json::parse(json_report(sample_results()));
  BOOST_TEST(json.at("cells").at(2).at("metrics").at("position_error").at("value") == "inf");
  const auto& crashed = json.at("cells").at(3);
  BOOST_TEST(crashed.at("status") == "crashed");
  BOOST_TEST(crashed.at("verdict").is_null());
  BOOST_TEST(crashed.at("trajectory").is_null());
  BOOST_TEST(crashed.at("reason").get<std::string>().find("SIGSEGV") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_message_brings_back_the_cell_that_was_sent) {
  using Part = MessageSubject::Part;
  const Results sent = sample_results();
  const Scene& scene = sent.cases.front().definition.scene;
  CaseResult received = sent.cases.front();
  for (Cell& cell : received.cells) {
    Cell blank;
    blank.run = cell.run, blank.dt = cell.dt;
    cell = blank;
  }
  for (std::size_t i = 0; i < received.cells.size(); ++i) {
    const Cell& cell = sent.cases.front().cells[i];
    BOOST_TEST((apply_message(received, message_of_cell(i, cell, scene)) == MessageSubject{Part::cell, i}));
    BOOST_TEST(text_of(json_of(received.cells[i], scene), 0) == text_of(json_of(cell, scene), 0));
    BOOST_TEST(received.cells[i].run == cell.run);
  }
  BOOST_TEST((apply_message(received, message_of_truth({1, 2, 3})) == MessageSubject{Part::truth}));
  BOOST_TEST(received.truth->horizon == 2);
  Spread spread{0, 1, {0.1, "1/10"}, {0.5, 0.25, 0}, {0.125, 0.375, 0}, 0.0625, 2};
  Spread together{1, 0, {0.05, "1/20"}, {}, {}, {}, 3};
  BOOST_TEST((apply_message(received, message_of_spreads({spread, together})) == MessageSubject{Part::spreads}));
  BOOST_TEST_REQUIRE(received.spreads.size() == 2u);
  const Spread& back = received.spreads.front();
  BOOST_TEST((back.first == 0 && back.second == 1 && back.dt.seconds == 0.1 && back.dt.text == "1/10"));
  BOOST_TEST((back.distance.value == 0.5 && back.distance.time == 0.25 && back.distance.body == 0));
  BOOST_TEST((back.angle.value == 0.125 && back.angle.time == 0.375));
  BOOST_TEST((back.parted_at == 0.0625 && back.compared_until == 2));
  BOOST_TEST(!received.spreads.back().parted_at.has_value());
  const std::string stable = message_of_stable_step(1, {Status::pass, "", {0.5, true, false}});
  BOOST_TEST((apply_message(received, stable) == MessageSubject{Part::stable_step, 1}));
  BOOST_TEST(received.stable_steps[1].step.is_cap);
}

BOOST_AUTO_TEST_SUITE_END()
