// rigor history, by the program itself.
#include <boost/test/unit_test.hpp>
#include <nlohmann/json.hpp>

#include "tests/cases/cli/program.h"

using namespace rigor;

namespace cases_cli_history {

using Json = nlohmann::json;

struct Fixture : Program {
  Fixture() {
    folder.write("stone.toml", kThrown);
    run({"run", "stone.toml", "--engine", "ode", "--out", "out"});
  }
  // The run again, as if its program had been another: `error` and `cost` times what they were.
  void add(double error, double cost, const std::string& commit) const {
    Json json = Json::parse(content("out/results.json"));
    Json& metrics = json["cells"][0]["metrics"];
    metrics["position_error"]["value"] = metrics["position_error"]["value"].get<double>() * error;
    metrics["cost"]["value"] = 1e-3 * cost;
    folder.write("later/results.json", json.dump());
    setenv("RIGOR_COMMIT", commit.c_str(), 1);
    const Answer answer = run({"history", "add", "later"});
    unsetenv("RIGOR_COMMIT");
    BOOST_TEST(answer.code == 0, answer.err);
  }
};

}  // namespace cases_cli_history

BOOST_FIXTURE_TEST_SUITE(cases_cli_history, Fixture)

BOOST_AUTO_TEST_CASE(a_change_of_an_error_is_marked_with_its_commit) {
  for (int i = 0; i < 5; ++i) add(1, 1, "old" + std::to_string(i));
  BOOST_TEST(run({"history", "show"}).out.find("1 without a change") != std::string::npos);
  add(2, 1, "worse"), add(2, 1, "later");
  const Answer shown = run({"history", "show"});
  BOOST_TEST(shown.code == 0);
  BOOST_TEST(shown.out.find("at worse (") != std::string::npos, shown.out);
  BOOST_TEST(shown.out.find("▁▁▁▁▁██") != std::string::npos, shown.out);
  BOOST_TEST(shown.out.find("at later (") == std::string::npos, shown.out);
  BOOST_TEST(run({"history", "show", "nothing-like-it"}).out.find("0 cells shown") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_cost_changes_beyond_its_noise_and_not_within) {
  for (int i = 0; i < 12; ++i) add(1, 1 + 0.05 * (i * 7 % 5), "a" + std::to_string(i));
  BOOST_TEST(run({"history", "show"}).out.find("1 without a change") != std::string::npos);
  for (int i = 0; i < 12; ++i) add(1, 2 + 0.05 * (i * 7 % 5), "b" + std::to_string(i));
  const Answer shown = run({"history", "show"});
  BOOST_TEST(shown.out.find("at b0 (") != std::string::npos, shown.out);
  BOOST_TEST(shown.out.find("0 without a change") != std::string::npos, shown.out);
}

BOOST_AUTO_TEST_CASE(a_page_draws_each_cell_and_marks_its_changes) {
  for (int i = 0; i < 5; ++i) add(1, 1, "old" + std::to_string(i));
  add(2, 1, "<worse>");
  BOOST_TEST(run({"history", "show", "--page", "history.html"}).code == 0);
  const std::string page = content("history.html");
  BOOST_TEST(page.find("1 of 1 cells changed") != std::string::npos);
  BOOST_TEST(page.find("from 0.5 to 1 at &lt;worse&gt;") != std::string::npos, page.substr(page.size() / 2));
  BOOST_TEST(page.find("<worse>") == std::string::npos);
  std::size_t marks = 0, changes = 0;
  for (std::size_t at = 0; (at = page.find("<circle", at)) != std::string::npos; ++at)
    ++marks, changes += page.compare(page.find("fill=", at), 14, "fill=\"#b3261e\"") == 0;
  BOOST_TEST(marks == 12u);  // six entries, an error and a cost of each
  BOOST_TEST(changes == 1u);
  const Answer nowhere = run({"history", "show", "--page", "none/history.html"});
  BOOST_TEST(nowhere.code == 2);
  BOOST_TEST(nowhere.err.find("--page none/history.html") != std::string::npos, nowhere.err);
}

BOOST_AUTO_TEST_CASE(each_entry_says_its_commit_date_and_machine) {
  add(1, 1, "abc");
  const Json entry = Json::parse(content("history.jsonl"));
  BOOST_TEST(entry.at("commit") == "abc");
  BOOST_TEST(entry.at("date").get<std::string>().size() == 20u);
  BOOST_TEST(entry.at("machine").get<std::string>().find("cores") != std::string::npos);
  BOOST_TEST(entry.at("cells")[0].at("engine") == "ode");
  BOOST_TEST(entry.at("cells")[0].at("cost").get<double>() == 1e-3);
}

BOOST_AUTO_TEST_CASE(what_is_no_history_is_refused_and_left_as_it_was) {
  add(1, 1, "abc");
  const std::string good = content("history.jsonl");
  struct Row {
    std::vector<std::string> words;
    std::string expected;
  };
  folder.write("cut.jsonl", good.substr(0, good.size() / 2));
  folder.write("other.jsonl", "{\"a\": 1}\n");
  folder.write("empty/results.json", "");
  const std::vector<Row> rows = {{{"history"}, "allowed: add DIR"},
                                 {{"history", "ad", "out"}, "did you mean 'add'"},
                                 {{"history", "add"}, "one folder"},
                                 {{"history", "add", "nowhere"}, "cannot be read"},
                                 {{"history", "add", "empty"}, "results.json"},
                                 {{"history", "add", "out", "--file", "cut.jsonl"}, "cut short"},
                                 {{"history", "add", "out", "--file", "other.jsonl"}, "line 1"},
                                 {{"history", "show", "--file", "none.jsonl"}, "cannot be read"},
                                 {{"history", "show", "--file", "cut.jsonl"}, "cut short"}};
  for (const Row& row : rows) {
    const Answer answer = run(row.words);
    BOOST_TEST(answer.code == 2, row.expected);
    BOOST_TEST(answer.err.find(row.expected) != std::string::npos, answer.err);
  }
  BOOST_TEST(content("other.jsonl") == "{\"a\": 1}\n");
  BOOST_TEST(content("cut.jsonl") == good.substr(0, good.size() / 2));
}

BOOST_AUTO_TEST_SUITE_END()
