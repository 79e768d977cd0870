#include "cases/results/baseline.h"

#include <sys/stat.h>

#include <boost/test/unit_test.hpp>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/error.h"
#include "tests/cases/judged.h"
#include "tests/cases/results/gated_results.h"

using namespace rigor;
using rigor::test::says;

BOOST_AUTO_TEST_SUITE(cases_results_baseline)

// Infinity was null in results.json of the first schema; a metric of another version is none that there is.
BOOST_AUTO_TEST_CASE(results_of_other_versions_are_read_as_far_as_they_mean_the_same) {
  const Folder folder;
  const auto read = [&](const auto& change) {
    auto json = nlohmann::json::parse(json_report(gated_results()));
    change(json["cells"][0]["metrics"], json);
    return read_baseline(folder.write("results.json", json.dump())).cells.begin()->second.metrics;
  };
  const auto old = read([](auto& metrics, auto& json) {
    json["schema"] = 1, metrics["position_error"]["value"] = nullptr;
    metrics["niceness"] = metrics["energy_drift"];
  });
  BOOST_TEST(old.at("position_error") == HUGE_VAL);
  BOOST_TEST(old.at("energy_drift") == 0.5);
  BOOST_TEST(!old.contains("niceness"));
  for (const char* word : {"inf", "-inf", "nan"}) {
    const auto values = read([&](auto& metrics, auto&) { metrics["position_error"]["value"] = word; });
    BOOST_TEST(values.at("position_error") == HUGE_VAL, word);
  }
  for (const int schema : {0, 3})
    BOOST_CHECK_THROW(read([&](auto&, auto& json) { json["schema"] = schema; }), InputError);
}

BOOST_AUTO_TEST_CASE(results_that_say_what_there_is_not_are_refused_with_the_place) {
  const Folder folder;
  const auto refusal = [&](const std::function<void(nlohmann::json&)>& change) {
    auto json = nlohmann::json::parse(json_report(gated_results()));
    change(json);
    try {
      read_baseline(folder.write("results.json", json.dump()));
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string("read");
  };
  const auto check = [&](const std::string& part, const std::function<void(nlohmann::json&)>& change) {
    const std::string text = refusal(change);
    BOOST_TEST(text.find(part) != std::string::npos, part << ": " << text);
  };
  check("cells[1]: there is no status 'passed'", [](auto& json) { json["cells"][1]["status"] = "passed"; });
  check("cells[0]: metrics: found null", [](auto& json) { json["cells"][0]["metrics"] = nullptr; });
  check("cells[0]: position_error: found \"small\"",
        [](auto& json) { json["cells"][0]["metrics"]["position_error"]["value"] = "small"; });
  check("neither", [](auto& json) { json["cells"][0]["metrics"]["position_error"] = nlohmann::json::object(); });
  check("neither", [](auto& json) { json["cells"][0]["status"] = nullptr; });
  check("cases[0]: gate of position_error: there is no answer 'holds'",
        [](auto& json) { json["cases"][0]["gates"][0]["answers"][0]["answer"] = "holds"; });
  check("cells[4]: is there twice", [](auto& json) { json["cells"].push_back(json["cells"][0]); });
  check("read", [](auto&) {});
}

BOOST_AUTO_TEST_CASE(a_baseline_is_lines_of_json_and_says_the_same_when_written_again) {
  const std::string text = baseline_text(outcomes_of(gated_results()));
  std::istringstream lines(text);
  std::string line;
  std::getline(lines, line);
  const auto title = nlohmann::json::parse(line);
  BOOST_TEST(title.at("rigor_baseline") == 2);
  bool has_cell = false;
  while (std::getline(lines, line)) {
    const auto json = nlohmann::json::parse(line);
    BOOST_TEST(!json.contains("gate"), line);  // those of one cell that hold follow from it
    if (!json.contains("status") || json.at("engine") != "good" || json.at("dt") != "1/10") continue;
    has_cell = true;
    BOOST_TEST(json.at("case") == "family/case");
    BOOST_TEST(json.at("status") == "pass");
    BOOST_TEST(json.at("metrics").at("position_error") == 0.25);
    BOOST_TEST(json.at("metrics").at("energy_drift") == 0.5);
  }
  BOOST_TEST(has_cell, text);
  const Folder folder;
  BOOST_TEST(baseline_text(read_baseline(folder.write("b", text))) == text);
}

BOOST_AUTO_TEST_CASE(what_is_neither_is_refused_with_its_name) {
  const Folder folder;
  const auto read = [&](const std::string& text) { return read_baseline(folder.write("file", text)); };
  BOOST_CHECK_EXCEPTION(read_baseline((folder.path / "none").string()), InputError, says("cannot be read"));
  for (const char* text : {"", "{}", "[1]", "not json", "{\"schema\": 1}", "{\"schema\": \"1\"}"})
    BOOST_CHECK_EXCEPTION(read(text), InputError, says("neither"));
  BOOST_CHECK_EXCEPTION(read("{\"schema\": 99}"), InputError, says("99"));
  BOOST_CHECK_EXCEPTION(read("# Rigor baseline 1\ncell\ta\n"), InputError, says("older form; make it anew"));
  const std::string title = "{\"rigor_baseline\":2,\"metrics\":[]}\n",
                    cell = "{\"case\":\"a\",\"engine\":\"b\",\"dt\":\"1\",";
  BOOST_CHECK_EXCEPTION(read(title + "{\"case\":\"a\"}\n"), InputError, says("line 2"));
  BOOST_CHECK_EXCEPTION(read(title + "not json\n"), InputError, says("line 2"));
  BOOST_CHECK_EXCEPTION(read(title + cell + "\"status\":\"passed\",\"metrics\":{}}\n"), InputError, says("'passed'"));
  BOOST_CHECK_EXCEPTION(read(title + cell + "\"status\":\"pass\",\"metrics\":{\"x\":\"y\"}}\n"), InputError,
                        says("line 2: x: found \"y\""));
  BOOST_CHECK_EXCEPTION(read("{\"rigor_baseline\":3,\"metrics\":[]}\n"), InputError, says("is not 2"));
}

// Neither may be read as a result, nor for ever.
BOOST_AUTO_TEST_CASE(what_is_no_regular_file_is_refused) {
  const Folder folder;
  const std::string pipe = (folder.path / "pipe").string();
  BOOST_REQUIRE(::mkfifo(pipe.c_str(), 0600) == 0);
  for (const std::string& path : {folder.path.string(), pipe, std::string("/dev/zero")})
    BOOST_CHECK_EXCEPTION(read_baseline(path), InputError, says("not a regular file"));
}

BOOST_AUTO_TEST_SUITE_END()
