// How a cell's error and cost are followed along a history.
#include "cases/analysis/cell_history.h"

#include <boost/test/unit_test.hpp>
#include <cmath>

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_analysis_cell_history)

namespace {

const CellKey kKey = {"a", "ode", "1/30"};

HistoryEntry entry(double error, std::optional<double> cost, const std::string& machine = "here") {
  HistoryEntry made{"commit", "2026-01-31T12:00:00Z", machine, {}};
  made.cells[kKey] = {Status::pass, {{"position_error", error}}, cost};
  return made;
}

CellHistory only(const std::vector<HistoryEntry>& history) { return cell_histories(history, {}).at(0); }

std::vector<HistoryEntry> with_errors(const std::vector<double>& errors) {
  std::vector<HistoryEntry> history;
  for (const double error : errors) history.push_back(entry(error, std::nullopt));
  return history;
}

}  // namespace

// A history keeps four digits, so that 1.000 and 1.001 may be the same number.
BOOST_AUTO_TEST_CASE(an_error_changes_with_its_third_digit) {
  using Indices = std::vector<std::size_t>;
  BOOST_TEST(only(with_errors({1, 1.001, 1})).error.changes == Indices{});
  BOOST_TEST(only(with_errors({1, 1, 1.002})).error.changes == Indices{2});
  BOOST_TEST(only(with_errors({1.002, 1, 1})).error.changes == Indices{1});
  BOOST_TEST(only(with_errors({1, 1.15, 1.15})).error.changes == Indices{1});
  BOOST_TEST(only(with_errors({1, 1, 0.85})).error.changes == Indices{2});
}

BOOST_AUTO_TEST_CASE(errors_that_are_rounding_do_not_change) {
  BOOST_TEST(only(with_errors({1e-13, 3e-16, 0})).error.changes.empty());
  BOOST_TEST(only(with_errors({1e-13, 3e-12})).error.changes.size() == 1u);
}

BOOST_AUTO_TEST_CASE(a_cost_changes_as_a_ratio_on_the_machine_of_the_last_entry) {
  std::vector<HistoryEntry> history;
  for (int i = 0; i < 4; ++i) history.push_back(entry(1, 1e-3));
  for (int i = 0; i < 4; ++i) history.push_back(entry(1, 9e-3, "there"));
  for (int i = 0; i < 4; ++i) history.push_back(entry(1, 1e-3));
  CellHistory cell = only(history);
  BOOST_TEST(cell.cost.changes.empty());
  for (std::size_t i = 4; i < 8; ++i) BOOST_TEST(std::isnan(cell.cost.values[i]), i);
  // The same costs of one machine are two changes.
  for (HistoryEntry& one : history) one.machine = "here";
  cell = only(history);
  BOOST_TEST((cell.cost.changes == std::vector<std::size_t>{4, 8}));
  const LevelChange change = level_change(cell.cost, 0);
  BOOST_TEST(change.entry == 4u);
  BOOST_TEST(change.before == 1e-3);
  BOOST_TEST(change.after == 9e-3);
  BOOST_TEST(level_change(cell.cost, 1).after == 1e-3);
}

// Entries without a cost are left out of the test, and the index still counts them.
BOOST_AUTO_TEST_CASE(six_entries_show_a_fivefold_cost_and_a_percent_is_noise) {
  std::vector<HistoryEntry> history;
  for (int i = 0; i < 3; ++i) history.push_back(entry(1, 1e-3 * (1 + 0.05 * i)));
  history.push_back(entry(1, std::nullopt));
  history.push_back(entry(1, 0.0));
  for (int i = 0; i < 3; ++i) history.push_back(entry(1, 5e-3 * (1 + 0.05 * i)));
  BOOST_TEST((only(history).cost.changes == std::vector<std::size_t>{5}));
  history.clear();
  for (int i = 0; i < 12; ++i) history.push_back(entry(1, i < 6 ? 1e-3 : 1.01e-3));
  BOOST_TEST(only(history).cost.changes.empty());
}

BOOST_AUTO_TEST_SUITE_END()
