// The program where something stops it: a full disk, too few descriptors, another run in its folder, a signal at any
// moment. What is there is always whole, old or new, and --resume goes on from it.
#include <sys/resource.h>

#include <boost/test/unit_test.hpp>
#include <chrono>
#include <thread>

#include "cases/report/reports.h"
#include "tests/cases/cli/suite_program.h"

using namespace rigor;
using namespace rigor::test;

BOOST_FIXTURE_TEST_SUITE(cases_cli_interruption, SuiteProgram)

BOOST_AUTO_TEST_CASE(a_report_that_cannot_be_written_costs_itself_and_resume_goes_on) {
  const auto limit = [](rlim_t bytes) {
    return [bytes] {
      const rlimit small{bytes, RLIM_INFINITY};
      setrlimit(RLIMIT_FSIZE, &small);
    };
  };
  const std::vector<std::string> words = {"run", "stone", "--engine", "core:rk4", "--out", out};
  folder.write("out/report.md", "old"), folder.write("out/results.json", "old");
  BOOST_TEST(run(words, limit(0)).code == 3);  // not even a message can be written to the test's file
  BOOST_TEST(content(fs::path(out) / "report.md") == "old");
  BOOST_TEST(content(fs::path(out) / "results.json") == "old");
  if (!RIGOR_HTML_REPORT) return;
  const Answer some = run(words, limit(200'000));  // the page alone is larger
  BOOST_TEST(some.code == 3);
  BOOST_TEST(some.err.find("report.html was not written: File too large") != std::string::npos, some.err);
  BOOST_TEST(some.err.find("results.json was not") == std::string::npos, some.err);
  BOOST_TEST(results().at("cells").size() == 2u);
  BOOST_TEST(!fs::exists(fs::path(out) / "report.html"));
  std::vector<std::string> with_resume = words;
  with_resume.push_back("--resume");
  const fs::path journal = fs::path(out) / ".rigor-partial/journals/0.journal";
  BOOST_TEST(content(journal).find("position_error") != std::string::npos);
  BOOST_TEST(run(with_resume).code == 0);
  BOOST_TEST(std::distance(fs::directory_iterator(out), {}) == std::ssize(reports()) + 1);  // and the trajectories
}

BOOST_AUTO_TEST_CASE(too_few_descriptors_end_in_a_sentence_and_never_in_success) {
  for (const rlim_t count : {7, 8}) {  // fewer than the program, the case and the cell need together
    const Answer answer = run({"run", "stone", "--engine", "core:rk4", "--out", out}, [count] {
      const rlimit few{count, count};
      setrlimit(RLIMIT_NOFILE, &few);
    });
    BOOST_TEST((answer.code == 2 || answer.code == 3), count << " descriptors: " << answer.code);
    BOOST_TEST(answer.err.find("Too many open files") != std::string::npos, answer.err);
  }
}

BOOST_AUTO_TEST_CASE(a_folder_that_another_run_writes_to_is_left_alone) {
  const std::vector<std::string> endless = {"run", "stone", "--engine", "core:rk4", "--dt", "1e-8", "--out", out};
  const pid_t first = start(endless);
  const fs::path journals = fs::path(out) / ".rigor-partial/journals";
  for (int i = 0; i < 500 && !fs::exists(journals); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  const Answer second = run({"run", "stone", "--engine", "core:rk4", "--out", out, "--resume"});
  BOOST_TEST(second.code == 2);
  BOOST_TEST(second.err.find("another run is writing to it") != std::string::npos, second.err);
  BOOST_TEST(kill(first, 0) == 0);
  BOOST_TEST(fs::exists(journals));
  BOOST_TEST(!fs::exists(fs::path(out) / "results.json"));
  kill(first, SIGKILL), wait_for(first);
}

// The first of two cells is journalled, the second never ends. What is computed anew has another time on the wall.
BOOST_AUTO_TEST_CASE(a_run_goes_on_from_its_own_build_alone) {
  const fs::path program = folder.path / "rigor", journal = fs::path(out) / ".rigor-partial/journals/0.journal";
  fs::copy_file(RIGOR_PROGRAM, program);
  const auto written = fs::last_write_time(program);
  for (const bool is_changed : {false, true}) {
    const pid_t pid = start(
        {"run", "stone", "--engine", "core:rk4", "--engine", "core:explicit-euler", "--dt", "1/10", "--dt", "1e-8",
         "--jobs", "1", "--duration", "1", "--out", out},
        [] {}, program.string());
    const std::string key = "\"wall_seconds\":";
    for (int i = 0; i < 1000 && content(journal).find(key) == std::string::npos; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    kill(pid, SIGKILL), wait_for(pid);
    const std::string kept = content(journal);
    BOOST_TEST_REQUIRE(kept.find(key) != std::string::npos);
    const double was = std::strtod(kept.c_str() + kept.find(key) + key.size(), nullptr);
    if (is_changed) {  // another build of the same age, put there as a linker does
      const fs::path other = folder.path / "other";
      fs::copy_file(program, other);
      std::ofstream(other, std::ios::binary | std::ios::app) << '\0';
      BOOST_TEST_REQUIRE(fs::file_size(other) == fs::file_size(program) + 1);
      fs::rename(other, program);
    }
    fs::last_write_time(program, written);
    const Answer resumed = wait_for(start(
        {"run", "stone", "--engine", "core:rk4", "--engine", "core:explicit-euler", "--dt", "1/10", "--dt", "1e-8",
         "--jobs", "1", "--duration", "1", "--timeout", "0.3", "--out", out, "--resume"},
        [] {}, program.string()));
    BOOST_TEST(resumed.code == 3);  // for the endless ones
    std::string times;
    bool is_found = false;
    for (const auto& cell : cells()) {
      const double now = cell.at("wall_seconds").get<double>();
      is_found = is_found || now == was;
      times += std::to_string(now) + " ";
    }
    BOOST_TEST(is_found == !is_changed, "kept " << was << ", now " << times);
  }
}

BOOST_AUTO_TEST_CASE(a_killed_run_leaves_the_old_outputs_and_no_child) {
  folder.write("out/results.json", "old");
  for (const int signal : {SIGINT, SIGTERM, SIGKILL}) {
    const pid_t pid = start({"run", "stone", "--engine", "core:rk4", "--dt", "1e-8", "--out", out});
    const fs::path growing = fs::path(out) / ".rigor-partial";
    for (int i = 0; i < 500 && !fs::exists(growing); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));  // its children are at work then
    BOOST_TEST(kill(pid, signal) == 0);
    BOOST_TEST(wait_for(pid).code == -signal);
    bool is_empty = false;  // the group of the program and all its children
    for (int i = 0; i < 500 && !is_empty; ++i) {
      is_empty = kill(-pid, 0) != 0;
      if (!is_empty) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    BOOST_TEST(is_empty);
    BOOST_TEST(content(fs::path(out) / "results.json") == "old");
    BOOST_TEST(fs::exists(growing));  // for --resume; any other run tidies it up
  }
}

// As a script's `trap "" INT` or nohup does it: what the leader of a group was told to ignore, its children ignore too.
BOOST_AUTO_TEST_CASE(a_signal_that_the_program_was_told_to_ignore_stops_no_cell) {
  for (const int signal : {SIGINT, SIGHUP, SIGTERM}) {
    const pid_t pid = start({"run", "stone", "--engine", "core:rk4", "--dt", "1e-6", "--out", out},
                            [&] { ::signal(signal, SIG_IGN); });
    const fs::path growing = fs::path(out) / ".rigor-partial";
    for (int i = 0; i < 500 && !fs::exists(growing); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    for (int i = 0; i < 5; ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      kill(-pid, signal);  // the group of the program and its children
    }
    BOOST_TEST(wait_for(pid).code == 0);
    for (const auto& cell : cells()) BOOST_TEST(cell.at("status") == "pass");
  }
}

BOOST_AUTO_TEST_CASE(an_interrupted_command_offers_to_resume_only_if_it_can) {
  for (const bool can : {true, false}) {
    std::vector<std::string> words = {can ? "run" : "trace", "stone", "--engine", "core:rk4", "--dt", "1e-8"};
    words.insert(words.end(), {can ? "--out" : "--every", can ? out : "1000"});
    const pid_t pid = start(words);
    const fs::path growing = fs::path(out) / ".rigor-partial";
    for (int i = 0; can && i < 2000 && !fs::exists(growing); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    std::this_thread::sleep_for(std::chrono::milliseconds(500));
    kill(pid, SIGINT);
    const Answer answer = wait_for(pid);
    BOOST_TEST(answer.code == -SIGINT);
    BOOST_TEST((answer.err.find("--resume") != std::string::npos) == can, answer.err);
  }
}

// A longer run over a shorter one's outputs, killed at about the instant at which its own appear.
BOOST_AUTO_TEST_CASE(a_run_killed_while_it_publishes_goes_on_to_its_own_trajectories) {
  const auto words = [&](const std::string& duration) -> std::vector<std::string> {
    return {"run", "stone", "--engine", "core:rk4", "--dt", "1/100", "--duration", duration, "--out", out};
  };
  const fs::path file = fs::path(out) / "results.json";
  for (int i = 0; i < 6; ++i) {
    run(words("0.5"));
    const std::string old = content(file);
    const pid_t pid = start(words("1"));
    for (int k = 0; k < 100'000 && content(file) == old; ++k)
      std::this_thread::sleep_for(std::chrono::microseconds(100 + 200 * i));
    kill(pid, SIGKILL), wait_for(pid);
    std::vector<std::string> with_resume = words("1");
    with_resume.push_back("--resume");
    BOOST_TEST(run(with_resume).code == 0);
    for (const auto& cell : cells()) {
      const auto rows = lines_of(content(fs::path(out) / "trajectories" / cell.at("trajectory").get<std::string>()));
      BOOST_TEST(rows.size() == 102u);  // its head, the start and a hundred steps
    }
  }
}

// A grid of slow cells, killed at one moment after another and continued. The files are always complete, old or new,
// and finished cells are not repeated.
BOOST_AUTO_TEST_CASE(a_run_killed_at_any_moment_leaves_whole_files_and_goes_on_from_there) {
  const std::vector<std::string> words = {"run",     "--engine", "core:rk4", "--engine", "ode", "--dt",
                                          "1/20000", "--jobs",   "1",        "--out",    out};
  const auto with_resume = [&] {
    std::vector<std::string> all = words;
    all.push_back("--resume");
    return all;
  };
  folder.write("out/results.json", "old");
  int kills = 0;
  for (int ms = 20; kills < 40; ms += 40, ++kills) {
    const pid_t pid = start(with_resume());
    std::this_thread::sleep_for(std::chrono::milliseconds(ms));
    kill(pid, SIGKILL);
    const bool has_ended = wait_for(pid).code >= 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // what publishes lives on
    const std::string text = content(fs::path(out) / "results.json");
    BOOST_TEST((text == "old" || nlohmann::json::accept(text)));
    if (has_ended) break;
  }
  BOOST_TEST(kills > 3);
  BOOST_TEST(run(with_resume()).code == 0);
  const auto resumed = results();
  const auto rows = [&](const nlohmann::json& cell) {
    return content(fs::path(out) / "trajectories" / cell.at("trajectory").get<std::string>());
  };
  std::vector<std::string> resumed_rows;
  for (const auto& cell : resumed.at("cells")) resumed_rows.push_back(rows(cell));
  run(words);
  const auto anew = results();
  BOOST_TEST_REQUIRE(resumed.at("cells").size() == anew.at("cells").size());
  for (std::size_t i = 0; i < anew.at("cells").size(); ++i) {
    BOOST_TEST(resumed.at("cells")[i].at("status") == anew.at("cells")[i].at("status"));
    BOOST_TEST(resumed.at("cells")[i].at("metrics").at("position_error") ==
               anew.at("cells")[i].at("metrics").at("position_error"));
    BOOST_TEST((resumed_rows[i] == rows(anew.at("cells")[i])), "the rows of cell " << i);
  }
  for (const auto& entry : fs::directory_iterator(out))
    BOOST_TEST(!entry.path().filename().string().starts_with("."), entry.path().string());
}

BOOST_AUTO_TEST_SUITE_END()
