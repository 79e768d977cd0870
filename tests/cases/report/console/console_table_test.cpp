#include "cases/report/console/console_table.h"

#include <algorithm>
#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <set>
#include <sstream>

#include "cases/report/layout.h"
#include "tests/cases/limit_as.h"
#include "tests/cases/report/sample_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_console_console_table)

namespace {

std::string line_with(const std::string& text, const std::string& start) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(start)) return line;
  }
  return "";
}

}  // namespace

BOOST_AUTO_TEST_CASE(a_row_shows_errors_signed_drift_and_the_largest_step) {
  const std::string line = line_with(console_table(sample_results()), "  good ");
  for (const char* part : {" 0.125 ", " 0.25 ", " -50 ", " 0.0678 ", " stable"}) {
    BOOST_TEST(line.find(part) != std::string::npos, part << " in " << line);
  }
}

BOOST_AUTO_TEST_CASE(a_run_that_blew_up_shows_when_and_what_and_no_errors) {
  const std::string line = line_with(console_table(sample_results()), "  wild ");
  BOOST_TEST(line.find("blown up at 0.40 s: st|one") != std::string::npos, line);
  BOOST_TEST(line.find("0.125") == std::string::npos, line);
  BOOST_TEST(line.find("timed-out") != std::string::npos, line);  // of its largest stable step
}

BOOST_AUTO_TEST_CASE(a_cell_without_numbers_says_why) {
  Results results = sample_results();
  results.cases.front().definition.dt = {{0.05, "1/20"}};  // where the second engine crashed
  const std::string line = line_with(console_table(results), "  wild ");
  BOOST_TEST(line.find("crashed: killed by SIGSEGV") != std::string::npos, line);
}

BOOST_AUTO_TEST_CASE(what_several_runs_cannot_do_for_one_reason_is_one_sentence) {
  Results results = sample_results();
  std::vector<Cell>& cells = results.cases.front().cells;
  for (Cell& cell : cells)
    cell.status = Status::unsupported, cell.metrics.clear(),
    cell.reason = results.runs[cell.run].text + " has no springs";
  const std::string text = console_table(results);
  BOOST_TEST(text.find("2 runs unsupported: no springs: good, wild") != std::string::npos, text);
  BOOST_TEST(text.find("no springs") == text.rfind("no springs"), text);
  cells[0].reason = "good has no joints";  // of one's own
  BOOST_TEST(line_with(console_table(results), "  good ").find("unsupported: good has no joints") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_verdict_stands_with_its_amount_and_a_sentence_says_what_it_stands_on) {
  Results results = sample_results();
  results.cases.front().cells[0].stability = {Verdict::gaining, 0.3, kWorld, "it rose by 13 %", 0.13};
  const std::string text = console_table(results);
  BOOST_TEST(line_with(text, "  good   ").find("  gaining 13 %") != std::string::npos, text);
  BOOST_TEST(text.find("good is gaining: it rose by 13 %.") != std::string::npos, text);
}

BOOST_AUTO_TEST_CASE(every_line_fits_a_hundred_columns) {
  Results results = sample_results();
  std::string reason = "crashed because";
  for (int i = 0; i < 60; ++i) reason += " of one thing after another";
  results.cases.front().cells[2].metrics.clear();
  results.cases.front().cells[2].reason = reason;
  results.cases.front().cells[0].stability = {Verdict::blown_up, 123.4, 0, ""};
  results.cases.front().definition.scene.bodies.front().name = "a body of a name that no table was made for";
  results.runs[0].text = "core:explicit-euler,orientation=matrix-rodrigues";
  results.cases.front().definition.title = reason;
  results.cases.front().definition.gates.resize(1);
  results.cases.front().gates.push_back({0, "good", "1/10", GateAnswer::failed, reason});
  for (const std::size_t width : {100u, 60u}) {
    setenv("COLUMNS", std::to_string(width).c_str(), 1);
    std::istringstream lines(console_table(results));
    unsetenv("COLUMNS");
    for (std::string line; std::getline(lines, line);) BOOST_TEST(width_of(line) <= width, line);
  }
}

// Nothing is lost: a name and its verdict get a line of their own above the six numbers.
BOOST_AUTO_TEST_CASE(a_narrow_terminal_gets_the_same_words) {
  const Results results = sample_results();
  const auto words = [&](const char* columns) {
    setenv("COLUMNS", columns, 1);
    std::istringstream text(console_table(results));
    unsetenv("COLUMNS");
    std::multiset<std::string> all;
    for (std::string word; text >> word;) {
      std::erase(word, ':');  // stands between a name and its verdict where the table is narrow
      if (!word.empty() && !word.ends_with("..")) all.insert(word);  // a wide table cuts long verdicts
    }
    return all;
  };
  const auto narrow = words("60"), wide = words("100");
  BOOST_TEST(std::includes(narrow.begin(), narrow.end(), wide.begin(), wide.end()));
  BOOST_TEST((words("not a number") == wide));
}

BOOST_AUTO_TEST_CASE(many_cases_stand_in_a_matrix_of_a_hundred_columns) {
  Results results = sample_results();
  const CaseResult one = results.cases.front();
  for (const char* id : {"family/other", "family/of-a-name-longer-than-any-column", "second/case", "second/more",
                         "second/last", "none"}) {
    results.cases.push_back(one);
    results.cases.back().definition.id = id;
  }
  results.cases[3].cells[0].metrics["position_error"].value = 0.9999e-3;
  results.cases[2].cells[0].stability = {Verdict::gaining, 0.3, kWorld, "", 0.5};
  results.cases[4].cells[0].status = Status::known_deviation;
  results.cases[5].definition.gates.resize(1);
  results.cases[5].gates.push_back({0, "good", "1/10", GateAnswer::failed, "too far"});
  results.cases[5].gates.push_back({0, "", "", GateAnswer::not_checked, "no cell"});
  while (results.runs.size() < 9) {  // each of an engine of its own
    results.runs.push_back(results.runs.front());
    results.runs.back().engine = std::string("engine") + std::to_string(results.runs.size());
  }
  for (CaseResult& result : results.cases) {
    for (std::size_t run = 2; run < results.runs.size(); ++run) {
      result.stable_steps.push_back(result.stable_steps.front());
      result.cells.push_back(result.cells.front()), result.cells.back().run = run;
    }
  }
  results.runs[8].text = "core:semi-implicit-euler,orientation=matrix-additive@stock";
  const std::string text = console_table(results);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    BOOST_TEST(std::count_if(line.begin(), line.end(), [](char c) { return (c & 0xc0) != 0x80; }) <= 100, line);
  }
  BOOST_TEST(line_with(text, " other").find("✓▓250mm    ✕ 0.40s    ✓▓250mm") != std::string::npos, text);
  BOOST_TEST(line_with(text, " case").find("✓▓250mm") != std::string::npos, text);
  const std::string second = text.substr(text.find("\nsecond\n") + 1);
  BOOST_TEST(line_with(second, " case").find("✓ 1mm") != std::string::npos, text);  // 0.9999 mm
  BOOST_TEST(line_with(text, " of-a-name").find("↑▓250mm") != std::string::npos, text);
  BOOST_TEST(line_with(text, " more").find("◆▓250mm") != std::string::npos, text);
  BOOST_TEST(line_with(text, "  bound failed").find("too far") != std::string::npos, text);
  BOOST_TEST(text.find("not checked") == std::string::npos, text);
  BOOST_TEST(text.find("st|one") == std::string::npos, text);  // no block
  BOOST_TEST(text.find("more runs") == std::string::npos, text);
  // If they belong to only two engines, one run stands for each.
  for (RunName& run : results.runs) run.engine = run.text == "wild" ? "wild" : "good";
  const std::string folded = console_table(results);
  BOOST_TEST(line_with(folded, " other").ends_with("✓▓250mm    ✕ 0.40s"), folded);
  BOOST_TEST(folded.find("7 more runs") != std::string::npos, folded);
}

BOOST_AUTO_TEST_CASE(bounds_and_regressions_are_counted_apart) {
  Results results = sample_results();
  CaseResult& result = results.cases.front();
  result.definition.gates.resize(2);
  result.gates = {{0, "good", "1/10", GateAnswer::held, ""}, {0, "good", "1/20", GateAnswer::known_deviation, ""}};
  const std::string bounds = "bounds: 1 held, 0 failed, 0 not checked, 1 known deviations\n";
  BOOST_TEST(gate_summary(results) == bounds + "bounds of other runs or steps than were asked for: 1\n");
  test::limit_as<RegressionLimit>(result.definition.gates[1]).factor = 1.25;
  BOOST_TEST(gate_summary(results) == bounds);
  for (const GateAnswer answer : {GateAnswer::held, GateAnswer::failed, GateAnswer::not_recorded})
    result.gates.push_back({1, "good", "1/10", answer, "so much"});
  const std::string text = gate_summary(results);
  BOOST_TEST(text.ends_with("\nregressions: 1 held, 1 failed, 0 not checked, 1 without a recorded value\n"), text);
  BOOST_TEST(line_with(console_table(results), "  regression failed").find("so much") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_truth_says_how_far_it_can_be_trusted) {
  Results results = sample_results();
  CaseResult& result = results.cases.front();
  result.definition.truth = "reference", result.definition.duration = 30;
  result.truth->horizon = 17.81;
  BOOST_TEST(truth_sentence(result).find("until 17.8 s of the 30 s") != std::string::npos, truth_sentence(result));
  result.truth->horizon = 30;
  BOOST_TEST(truth_sentence(result).find("over the whole 30 s") != std::string::npos, truth_sentence(result));
  result.definition.truth = "none";
  BOOST_TEST(truth_sentence(result).find("none") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_run_of_reduced_order_has_a_mark_and_a_warning_that_says_from_when_on) {
  Results results = sample_results();
  BOOST_TEST(console_table(results).find("◐") == std::string::npos);
  results.cases.front().cells[0].reduced_order = ReducedOrder{0.93, "by short steps"};
  const std::string text = console_table(results);
  BOOST_TEST(line_with(text, "  good ").ends_with("stable ◐"), text);
  BOOST_TEST(text.find("warning: good (◐) is from 0.93 s on stepped by short steps") != std::string::npos, text);
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) BOOST_TEST(line.size() <= 104, line);  // bytes: ◐ has three
  results.cases.front().definition.gates.emplace_back();
  results.cases.front().gates.push_back(
      {0, "good", "1/10", GateAnswer::held, "it is small", 0.1, {}, "from 0.93 s on not by its method"});
  BOOST_TEST(console_table(results).find("warning: it is small, but from 0.93 s on") != std::string::npos);
  BOOST_TEST(gate_summary(results).find("warning: 1 of them held by runs") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_run_that_divides_its_steps_has_a_mark_and_a_note_of_the_step_really_taken) {
  Results results = sample_results();
  BOOST_TEST(console_table(results).find("÷") == std::string::npos);
  results.cases.front().cells[0].sub_step = 1.0 / 960;
  const std::string text = console_table(results);
  BOOST_TEST(line_with(text, "  good ").ends_with("stable ÷"), text);
  BOOST_TEST(text.find("good (÷) takes sub-steps of 1/960 s") != std::string::npos, text);
  results.cases.front().cells[0].sub_step = 0.0123;
  BOOST_TEST(console_table(results).find("good (÷) takes sub-steps of 0.0123 s") != std::string::npos);
}

BOOST_AUTO_TEST_SUITE_END()
