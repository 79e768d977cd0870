#include "cases/report/wording/comparison.h"

#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cases/report/console/console_table.h"
#include "cases/report/reports.h"
#include "tests/cases/priced_results.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_report_wording_comparison)

namespace {

// The core is of second order and half as dear as the others, which are of first; the two of them stay together.
Results compared() {
  Results results = test::priced_results({{"bullet", {{0.1, 0.2, 2e-5}, {0.05, 0.1, 4e-5}, {0.01, 0.02, 2e-4}}},
                                          {"core", {{0.1, 0.1, 1e-5}, {0.05, 0.025, 2e-5}, {0.01, 0.001, 1e-4}}},
                                          {"ode", {{0.1, 0.2, 1e-5}, {0.05, 0.1, 2e-5}, {0.01, 0.02, 1e-4}}}});
  const StepSize coarsest = results.cases.front().definition.dt.front();
  results.cases.front().spreads = {{0, 1, coarsest, {0.25, 0.5, 0}, {}, 0.2, 0.5},
                                   {0, 2, coarsest, {1e-15, 0.5, 0}, {}, {}, 0.5},
                                   {1, 2, coarsest, {0.25, 0.5, 0}, {}, 0.3, 0.5}};
  return results;
}

}  // namespace

BOOST_AUTO_TEST_CASE(the_tables_show_order_error_cost_gain_and_spread) {
  const Results results = compared();
  const auto tables = comparison_tables(results, results.cases.front());
  BOOST_TEST_REQUIRE(tables.size() == 3u);
  const std::vector<std::string> core = {"core", "2.00", "0.1 at 10", "0.025 at 20", "0.001 at 100"};
  BOOST_TEST(tables[0].rows[2] == core, boost::test_tools::per_element());
  // At bullet's first cost the core has its second cell, .025 for .2; at its last the core's finest, .001 for .02.
  const std::vector<std::string> gain = {"core", "8", "16", ">=20", "2", "4", "20"};
  BOOST_TEST(tables[1].rows[2] == gain, boost::test_tools::per_element());
  const std::vector<std::string> bullet = {"bullet", "", "0.25", "1e-15"}, ode = {"ode", "never", "0.3", ""};
  BOOST_TEST(tables[2].rows[1] == bullet, boost::test_tools::per_element());
  BOOST_TEST(tables[2].rows[3] == ode, boost::test_tools::per_element());
  for (const TextTable& table : tables) {
    for (const auto& row : table.rows) BOOST_TEST(row.size() == table.rows[0].size(), table.heading);
  }
}

BOOST_AUTO_TEST_CASE(the_console_says_in_a_sentence_what_equal_cost_buys) {
  const Results results = compared();
  const auto messages = work_precision_messages(results, results.cases.front());
  BOOST_TEST_REQUIRE(messages.size() == 2u);
  // At the cost of ode's coarsest step, 1e-5 s/s, the core has 0.1 m; at its finest, which both cost alike, 0.001 m.
  BOOST_TEST(
      messages[1].text ==
      "ode at dt = 0.100000 s takes 1 µs a step; its position error is 200 mm. At the same cost core has 100 mm. "
      "Times less error at equal cost: 2 at dt = 0.100000 s, 4 at 0.050000 s, 20 at 0.010000 s.");
  std::istringstream lines(console_table(results));
  for (std::string line; std::getline(lines, line);) BOOST_TEST(line.size() <= 100u, line);
}

BOOST_AUTO_TEST_CASE(a_run_that_blew_up_is_in_no_table) {
  Results results = compared();
  for (Cell& cell : results.cases.front().cells) {
    if (cell.run == 0) cell.status = Status::diverged;
  }
  for (const TextTable& table : comparison_tables(results, results.cases.front())) {
    for (const auto& row : table.rows) BOOST_TEST(row[0] != "bullet", table.heading);
  }
}

BOOST_AUTO_TEST_CASE(the_markdown_rows_have_the_columns_of_their_headers) {
  std::istringstream lines(markdown_report(compared()));
  std::size_t columns = 0, tables = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t bars = std::count(line.begin(), line.end(), '|');
    if (bars == 0) columns = 0;
    if (bars > 0 && columns == 0) columns = bars, ++tables;
    BOOST_TEST(bars == columns, line);
  }
  BOOST_TEST(tables == 7u);  // the matrix, one a step size, and three that compare
}

BOOST_AUTO_TEST_CASE(a_program_finds_them_in_the_results) {
  const auto json = nlohmann::json::parse(json_report(compared())).at("cases").at(0);
  const auto& order = json.at("observed_order").at(1);
  BOOST_TEST(order.at("engine") == "core");
  BOOST_TEST(std::abs(order.at("value").get<double>() - 2) < 1e-9);
  const auto& spread = json.at("spread").at(0);
  BOOST_TEST(spread.at("first") == "bullet");
  BOOST_TEST(spread.at("second") == "core");
  BOOST_TEST(spread.at("distance").at("value") == 0.25);
  BOOST_TEST(spread.at("distance").at("body") == "stone");
  BOOST_TEST(spread.at("parted_at") == 0.2);
  BOOST_TEST(json.at("spread").at(1).at("parted_at").is_null());
  const auto& work = json.at("work_precision").at(0);
  BOOST_TEST(work.at("metric") == "position_error");
  BOOST_TEST(work.at("points").size() == 9u);
  BOOST_TEST(work.at("points").at(0).at("cost") == 2e-5);
  BOOST_TEST(work.at("best_of_core").at(1).at("baseline") == "ode");
  BOOST_TEST(work.at("best_of_core").at(1).at("engine") == "core");
  BOOST_TEST(std::abs(work.at("best_of_core").at(1).at("times_less_at_worst").get<double>() - 2) < 1e-9);
}

BOOST_AUTO_TEST_SUITE_END()
