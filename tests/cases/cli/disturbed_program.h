// Runs the program over the outputs of an older run, for tests that disturb it. The outputs must be the old or the new,
// complete ones, and a continued run must give the bits of an undisturbed one. For files that define RIGOR_PROGRAM.
#pragma once

#include <boost/test/unit_test.hpp>
#include <map>
#include <set>

#include "cases/report/reports.h"
#include "tests/cases/cli/suite_program.h"
#include "tests/cases/cli/without_timings.h"

namespace rigor::test {

using Words = std::vector<std::string>;
using Files = std::map<std::string, std::string>;  // content by path in the folder

// Without what is hidden, which is the next run's.
inline Files files_in(const fs::path& folder) {
  Files files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).string();
    if (entry.is_regular_file() && !name.starts_with(".rigor-partial")) files[name] = content(entry.path());
  }
  return files;
}

struct DisturbedProgram : SuiteProgram {
  const fs::path old_out = folder.path / "old";
  const Words words = {"run",  "stone",  "--engine", "core:rk4", "--dt", "1/10",      "--dt",
                       "1/20", "--jobs", "1",        "--out",    out,    "--timeout", "20"};
  Files old, undisturbed;

  DisturbedProgram() {
    BOOST_TEST_REQUIRE(run({"run", "stone", "--engine", "core:rk4", "--engine", "core:explicit-euler", "--dt", "1/10",
                            "--duration", "0.5", "--out", old_out.string()})
                           .code == 0);
    BOOST_TEST_REQUIRE(run(words).code == 0);
    old = files_in(old_out), undisturbed = files_in(out);
    BOOST_TEST_REQUIRE(old.size() == reports().size() + 2);
    BOOST_TEST_REQUIRE(undisturbed.size() == reports().size() + 2);
    for (const auto& [name, bytes] : undisturbed) BOOST_TEST_REQUIRE((!old.contains(name) || old[name] != bytes), name);
  }

  void put_old_outputs_there() const {
    fs::remove_all(out);
    fs::copy(old_out, out, fs::copy_options::recursive);
  }
  Words words_to_resume() const {
    Words again = words;
    again.push_back("--resume");
    return again;
  }
  // Whoever is killed between two renames leaves that to the next run; it says so by what it leaves.
  bool is_half_published() const { return fs::exists(fs::path(out) / ".rigor-partial/staged/ready"); }

  // Checks the existing outputs; empty if all is well.
  std::string flaw_of(const Files& files, const Answer& answer) const {
    if (files == old) return answer.code == 0 ? "says that it is good, and nothing is new" : "";
    const std::string flaw = flaw_of_new(files, answer);
    if (!flaw.empty() || answer.code != 0) return flaw;
    return results_in(files) == results_in(undisturbed) ? "" : "says that it is good, and has other results";
  }
  std::string flaw_of_resumed(const Files& files, const Answer& answer) const {
    if (answer.code != 0) return "resuming answers " + std::to_string(answer.code) + ": " + answer.err;
    if (fs::exists(fs::path(out) / ".rigor-partial")) return "resuming leaves its hidden folder";
    return flaw_of(files, answer);
  }

 private:
  static nlohmann::json results_in(const Files& files) {
    nlohmann::json results = without_timings(nlohmann::json::parse(files.at("results.json")));
    results.erase("machine");  // which it has to ask for
    return results;
  }
  // Checks new outputs: all files must come from this run alone, and missing ones must be reported.
  std::string flaw_of_new(const Files& files, const Answer& answer) const {
    std::set<std::string> rest;
    for (const auto& [name, bytes] : files) rest.insert(name);
    for (const ReportRow& report : reports()) {
      const bool is_there = rest.erase(report.file_name) > 0;
      if (!is_there && answer.err.find(report.file_name + std::string(" was not written")) == std::string::npos)
        return report.file_name + std::string(" is missing and nothing is said of it");
      if (is_there && files.at(report.file_name) == old.at(report.file_name))
        return report.file_name + std::string(" is of the older run");
    }
    const std::string flaw = files.contains("results.json") ? flaw_of_results(files.at("results.json"), rest) : "";
    if (!flaw.empty()) return flaw;
    for (const auto& [name, bytes] : files) {
      if (name.starts_with("trajectories/") && (!undisturbed.contains(name) || undisturbed.at(name) != bytes))
        return name + " is not that of an undisturbed run";
    }
    return "";
  }
  // `rest`: the files that are no report, each of which a cell has to name.
  static std::string flaw_of_results(const std::string& text, std::set<std::string> rest) {
    if (!nlohmann::json::accept(text)) return "results.json is torn";
    const nlohmann::json results = nlohmann::json::parse(text);
    for (const auto& cell : results.at("cells")) {
      if (!cell.at("trajectory").is_string()) continue;
      const std::string trajectory = cell.at("trajectory").get<std::string>();
      if (!trajectory.empty() && rest.erase("trajectories/" + trajectory) == 0) return trajectory + " is not there";
    }
    return rest.empty() ? "" : *rest.begin() + " is in no result";
  }
};

}  // namespace rigor::test
