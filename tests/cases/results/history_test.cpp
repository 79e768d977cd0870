#include "cases/results/history.h"

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cases/report/reports.h"
#include "core/base/error.h"
#include "tests/cases/judged.h"
#include "tests/cases/report/sample_results.h"
#include "tests/folder.h"

using namespace rigor;
using rigor::test::says;

namespace cases_results_history {

const CellKey kGood = {"family/case", "good", "1/10"};

// The sample's results.json, changed.
struct Fixture : Folder {
  HistoryEntry entry(const auto& change) const {
    auto json = nlohmann::json::parse(json_report(sample_results()));
    change(json);
    return history_entry(write("results.json", json.dump()), "abc", "2026-01-31T12:00:00Z");
  }
  std::string history() const { return (path / "history.jsonl").string(); }
};

}  // namespace cases_results_history

BOOST_FIXTURE_TEST_SUITE(cases_results_history, Fixture)

BOOST_AUTO_TEST_CASE(an_entry_keeps_statuses_errors_and_costs_to_four_digits) {
  const HistoryEntry one = entry([](auto& json) {
    json["cells"][0]["metrics"]["cost"] = {{"value", 0.0123456}};
    json["cells"][0]["metrics"]["position_error"]["value"] = 0.123456;
    json["cells"][1]["metrics"]["cost"] = {{"value", "inf"}};
    json["cells"][2]["metrics"]["cost"] = {{"not_applicable", "not timed"}};
    json["machine"] = {{"cpu", "chip"}, {"cores", 2}, {"compiler", "cc 1"}, {"build_type", "Release"}};
  });
  BOOST_TEST((one.commit == "abc" && one.date == "2026-01-31T12:00:00Z"));
  BOOST_TEST(one.machine == "chip, 2 cores, cc 1, Release");
  BOOST_TEST_REQUIRE(one.cells.size() == 4u);
  const HistoryEntry::Cell& good = one.cells.at(kGood);
  BOOST_TEST((good.status == Status::pass && good.metrics.at("position_error") == 0.1235));
  BOOST_TEST(good.cost.value_or(0) == 0.01235);
  BOOST_TEST(!one.cells.at({"family/case", "good", "1/20"}).cost.has_value());  // none that is no number
  const HistoryEntry::Cell& blown_up = one.cells.at({"family/case", "wild", "1/10"});
  BOOST_TEST((blown_up.status == Status::diverged && std::isinf(blown_up.metrics.at("position_error"))));
  BOOST_TEST(!blown_up.cost.has_value());
}

BOOST_AUTO_TEST_CASE(what_is_added_comes_back_in_its_order) {
  HistoryEntry first = entry([](auto& json) { json["cells"][0]["metrics"]["cost"] = {{"value", 0.5}}; });
  HistoryEntry second = first;
  second.commit = "def", second.machine = "another", second.cells.erase(kGood);
  add_to_history(history(), first), add_to_history(history(), second);
  const auto entries = read_history(history());
  BOOST_TEST_REQUIRE(entries.size() == 2u);
  for (const auto& [was, is] : {std::pair(&first, &entries[0]), std::pair(&second, &entries[1])}) {
    BOOST_TEST((is->commit == was->commit && is->date == was->date && is->machine == was->machine));
    BOOST_TEST_REQUIRE(is->cells.size() == was->cells.size());
    for (const auto& [key, cell] : was->cells) {
      const HistoryEntry::Cell& back = is->cells.at(key);
      BOOST_TEST((back.status == cell.status && back.metrics == cell.metrics && back.cost == cell.cost), key.text());
    }
  }
}

BOOST_AUTO_TEST_CASE(what_is_no_history_or_no_results_is_refused_and_not_added_to) {
  const HistoryEntry one = entry([](auto&) {});
  add_to_history(history(), one);
  write("cut.jsonl", "{\"rigor_history\":1");
  BOOST_CHECK_EXCEPTION(add_to_history((path / "cut.jsonl").string(), one), InputError, says("cut short"));
  write("other.jsonl", "{\"rigor_history\":1,\"commit\":\"a\"}\n");
  BOOST_CHECK_EXCEPTION(read_history((path / "other.jsonl").string()), InputError, says("line 1"));
  write("later.jsonl", "{\"rigor_history\":2}\n");
  BOOST_CHECK_EXCEPTION(read_history((path / "later.jsonl").string()), InputError, says("is not 1"));
  BOOST_CHECK_THROW(add_to_history((path / "none/history.jsonl").string(), one), InputError);
  add_to_history(write("empty.jsonl", ""), one);
  BOOST_TEST(read_history((path / "empty.jsonl").string()).size() == 1u);
  BOOST_CHECK_EXCEPTION(entry([](auto& json) { json.erase("machine"); }), InputError,
                        says("says nothing of its machine"));
  BOOST_CHECK_EXCEPTION(entry([](auto& json) { json["machine"].erase("cpu"); }), InputError, says("no whole"));
}

BOOST_AUTO_TEST_SUITE_END()
