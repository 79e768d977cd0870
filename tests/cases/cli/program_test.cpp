// The program itself, run as a process: its words, its exit codes, what it prints and writes.
#include <boost/test/unit_test.hpp>

#include "cases/report/reports.h"
#include "tests/cases/cli/suite_program.h"

using namespace rigor;
using namespace rigor::test;

namespace cases_cli_program {

// The last number of a CSV row's n-th column from the end, 0 the last.
double from_the_end(const std::string& row, int n) {
  std::size_t end = row.size();
  for (int i = 0; i < n; ++i) end = row.rfind(',', end - 1);
  return std::strtod(row.c_str() + row.rfind(',', end - 1) + 1, nullptr);
}

}  // namespace cases_cli_program

BOOST_FIXTURE_TEST_SUITE(cases_cli_program, SuiteProgram)

BOOST_AUTO_TEST_CASE(help_and_version_are_on_stdout) {
  for (const std::vector<std::string>& words : {std::vector<std::string>{"--help"},
                                                {"--version"},
                                                {"list", "--help"},
                                                {"run", "--help"},
                                                {"gate", "--help"},
                                                {"compare", "--help"},
                                                {"trace", "--help"},
                                                {"truth", "--help"}}) {
    const Answer answer = run(words);
    BOOST_TEST(answer.code == 0);
    BOOST_TEST(!answer.out.empty());
    BOOST_TEST(answer.err == "");
  }
  for (const char* command : {"list", "run", "gate", "compare", "baseline", "trace", "truth", "settle"}) {
    BOOST_TEST(run({"--help"}).out.find(command) != std::string::npos, command);
  }
}

// A rod on a hinge with a fixed end, thrown: the hinge only lets it rotate. The momentum about the hinge, 1 kg × 0.5 m
// × 2 m/s, and its inertia there of 1/3 kg m² give 3 rad/s.
BOOST_AUTO_TEST_CASE(settle_prints_the_file_with_the_nearest_velocities_that_its_joints_allow) {
  const std::string text = R"(title = "thrown"
[[scene.body]]
name = "rod"
mass = 1
inertia = [0.01, 0.08333333333333333, 0.08333333333333333]
position = [0.5, 0, 0]
velocity = [1, 2, 0]  # m/s
[[scene.joint]]
type = "hinge"
a = "world"
b = "rod"
anchor = [0, 0, 0]
axis = [0, 0, 1]
[run]
duration = 1
dt = 0.1
)";
  const std::string file = folder.write("thrown.toml", text);
  const Answer refused = run({"run", file, "--out", out});
  BOOST_TEST(refused.code == 2);
  BOOST_TEST(refused.err.find("rigor settle") != std::string::npos, refused.err);
  const Answer settled = run({"settle", file});
  BOOST_TEST(settled.code == 0);
  const std::string again = folder.write("settled.toml", settled.out);
  BOOST_TEST(run({"settle", again}).out == settled.out);
  BOOST_TEST(run({"run", again, "--engine", "core:rk4", "--out", out}).code == 0);
  const auto turning = settled.out.find("angular_velocity = [0, 0, ");
  BOOST_TEST_REQUIRE(turning != std::string::npos, settled.out);
  BOOST_TEST(std::abs(std::stod(settled.out.substr(turning + 26)) - 3) < 1e-14);
}

BOOST_AUTO_TEST_CASE(bad_words_and_numbers_are_answered_on_stderr_with_exit_2_and_nothing_written) {
  struct Row {
    std::vector<std::string> words;
    std::string expected;  // in the message
  };
  const std::string file = folder.write("file", "");
  const std::vector<Row> rows = {
      {{}, "list"},
      {{"rnu"}, "did you mean 'run'"},
      {{"compar"}, "did you mean 'compare'"},
      {{"compare", file}, "two files"},
      {{"compare", file, "none"}, "neither"},
      {{"compare", file, file, "--factor", "0.5"}, "--factor"},
      {{"baseline", "none"}, "cannot be read"},
      {{"settle"}, "one file"},
      {{"settle", "none"}, "no such file"},
      {{"gate", "stone", "--deviations", "nowhere", "--out", out}, "no such folder"},
      {{"run", "--engin", "ode"}, "did you mean '--engine'"},
      {{"run", "ston"}, "stone"},
      {{"run", "stone", "--engine", "od"}, "--engine: 'od': there is no engine 'od' (did you mean 'ode'?)"},
      {{"trace", "stone", "--engine", "od", "--dt", "1/10"}, "--engine: 'od'"},
      {{"run", "stone", "--engine", "core:rk5"}, "did you mean 'core:rk4'|did you mean 'rk4'"},
      {{"run", "stone", "--engine", "ode@stok"}, "did you mean 'stock'"},
      {{"run", "stone", "--engine"}, "--engine"},
      {{"run", "stone", "--dt", "0"}, "--dt"},
      {{"run", "stone", "--dt", "-1"}, "--dt"},
      {{"run", "stone", "--dt", "nan"}, "--dt"},
      {{"run", "stone", "--dt", "inf"}, "--dt"},
      {{"run", "stone", "--dt", "1/0"}, "--dt"},
      {{"run", "stone", "--dt", "fast"}, "--dt"},
      {{"run", "stone", "--dt", "1e300"}, "longer than the run"},
      {{"run", "stone", "--dt", "1e-300"}, "at most"},
      {{"run", "stone", "--dt", "2"}, "longer than the run"},
      {{"run", "stone", "--duration", "-3"}, "--duration"},
      {{"run", "stone", "--duration", "1e300"}, "at most"},
      {{"run", "stone", "--jobs", "0"}, "--jobs"},
      {{"run", "stone", "--jobs", "many"}, "--jobs"},
      {{"run", "stone", "--timeout", "0"}, "--timeout"},
      {{"run", "stone", "--out", file}, "cannot be written"},
      {{"run", "stone", "--out", file + "/below"}, "cannot be written"},
      {{"list", "engine"}, "did you mean 'engines'"},
      {{"list", "--jobs", "2"}, "no option '--jobs'"},
      {{"trace"}, "takes one case"},
      {{"trace", "stone"}, "--engine"},
      {{"trace", "stone", "--engine", "ode"}, "takes exactly one --dt; air/stone has 1/10, 1/20"},
      {{"trace", "stone", "--engine", "ode", "--dt", "1/10", "--every", "0"}, "--every"},
      {{"trace", "air", "--engine", "ode", "--dt", "1/10"}, "one case"},
      {{"truth", "stone", "--times", "1,x"}, "--times"},
      {{"truth", "stone", "--times", "-1"}, "--times"},
      {{"truth", "stone", "--times", "1,,2"}, "--times"},
      {{"truth", "stone", "--times", ""}, "--times: needs a value"},
      {{"run", "list"}, "no case, family, file or folder 'list'"},  // which is also a command
      {{"run", ""}, "an empty word names no case"},
      {{"run", "stone", "--engine", ""}, "--engine: needs a value"},
      {{"run", "stone", "--dt", ""}, "--dt: needs a value"},
      {{"run", "stone", "--duration", ""}, "--duration: needs a value"},
      {{"run", "stone", "--jobs", ""}, "--jobs: needs a value"},
      {{"run", "stone", "--timeout", ""}, "--timeout: needs a value"},
      {{"run", "stone", "--out", ""}, "--out: needs a value"},
      {{"run", "--jobs=", "stone"}, "--jobs: needs a value"},
      {{"run", "--out=", "stone"}, "--out: needs a value"},
      {{"gate", "stone", "--deviations", "", "--out", out}, "--deviations: needs a value"},
      {{"list", "cases", "--suite", ""}, "--suite: needs a value"},
      {{"compare", file, file, "--factor", ""}, "--factor: needs a value"},
  };
  for (const Row& row : rows) {
    std::vector<std::string> words = row.words;
    if (!words.empty() && words[0] == "run" && std::find(words.begin(), words.end(), "--out") == words.end()) {
      words.insert(words.end(), {"--out", out});
    }
    std::string shown;
    for (const std::string& word : words) shown += word + " ";
    const Answer answer = run(words);
    BOOST_TEST(answer.code == 2, shown);
    BOOST_TEST(answer.out == "", shown);
    bool is_said = false;
    std::istringstream alternatives(row.expected);
    for (std::string part; std::getline(alternatives, part, '|');)
      is_said |= answer.err.find(part) != std::string::npos;
    BOOST_TEST(is_said, shown << "said: " << answer.err);
    BOOST_TEST(!fs::exists(out), shown);
  }
}

BOOST_AUTO_TEST_CASE(list_prints_every_table_and_each_by_itself) {
  const std::string all = run({"list"}).out;
  for (const std::vector<std::string>& row : std::vector<std::vector<std::string>>{{"cases", "air/stone"},
                                                                                   {"engines", "bullet"},
                                                                                   {"integrators", "core:rk4"},
                                                                                   {"metrics", "position_error"},
                                                                                   {"truths", "projectile"}}) {
    const Answer one = run({"list", row[0]});
    BOOST_TEST(one.code == 0);
    BOOST_TEST(one.out.find(row[1]) != std::string::npos, one.out);
    BOOST_TEST(all.find(one.out) != std::string::npos, row[0]);
  }
}

BOOST_AUTO_TEST_CASE(run_writes_its_reports_and_prints_the_table) {
  const Answer answer =
      run({"run", "stone", "--engine", "core:rk4", "--engine", "ode", "--engine", "ode", "--out", out});
  BOOST_TEST(answer.code == 0);
  // One line about the plan, and no progress bar without a terminal.
  BOOST_TEST(answer.err.starts_with("rigor: 1 case by 2 runs: 4 cells; "), answer.err);
  BOOST_TEST(std::count(answer.err.begin(), answer.err.end(), '\n') == 1, answer.err);
  BOOST_TEST(answer.out.find("core:rk4") != std::string::npos);
  BOOST_TEST(answer.out.find("\x1b") == std::string::npos);
  const auto json = nlohmann::json::parse(content(fs::path(out) / "results.json"));
  BOOST_TEST(json.at("cells").size() == 4u);
  for (const auto& cell : json.at("cells")) {
    BOOST_TEST(cell.at("status") == "pass");
    const fs::path csv = fs::path(out) / "trajectories" / cell.at("trajectory").get<std::string>();
    BOOST_TEST(content(csv).starts_with("time,body,px"), csv.string());
  }
  BOOST_TEST(content(fs::path(out) / "report.md").find("core:rk4") != std::string::npos);
  BOOST_TEST(fs::exists(fs::path(out) / "report.html") == bool(RIGOR_HTML_REPORT));
  BOOST_TEST(std::distance(fs::directory_iterator(out), {}) == std::ssize(reports()) + 1);  // and the trajectories
}

BOOST_AUTO_TEST_CASE(gate_answers_with_its_exit_code) {
  BOOST_TEST(run({"gate", "stone", "--engine", "core:rk4", "--out", out}).code == 0);
  const Answer strict = run({"gate", "strict", "--engine", "core:rk4", "--out", out});
  BOOST_TEST(strict.code == 1);
  BOOST_TEST(strict.out.find("bound failed") != std::string::npos, strict.out);
  BOOST_TEST(run({"run", "strict", "--engine", "core:rk4", "--out", out}).code == 0);
  const Answer unchecked = run({"gate", "stone", "--engine", "ode", "--out", out});
  BOOST_TEST(unchecked.code == 1);
  BOOST_TEST(unchecked.out.find("bound not checked") != std::string::npos, unchecked.out);
}

// An engine's author asks of that engine alone: gates of others are none of its business, and do not fail it.
BOOST_AUTO_TEST_CASE(gates_of_runs_that_were_not_named_are_left_out) {
  const std::string text = test::text_with("1"), gate = text.substr(text.find("[[gate]]"));
  std::string of_ode = gate;
  of_ode.replace(of_ode.find("core:rk4"), 8, "ode");
  of_ode.replace(of_ode.find("max"), of_ode.find('\n', of_ode.find("max")) - of_ode.find("max"), "max = 1e3");
  const std::string file = folder.write("both.toml", text + "\n" + of_ode);
  const Answer ode = run({"gate", file, "--engine", "ode", "--out", out});
  BOOST_TEST(ode.code == 0, ode.out);
  BOOST_TEST(ode.out.find("bounds of other runs or steps than were asked for: 1") != std::string::npos, ode.out);
  const Answer bullet = run({"gate", file, "--engine", "bullet", "--out", out});
  BOOST_TEST(bullet.code == 1, bullet.out);
  BOOST_TEST(bullet.out.find("bound not checked") != std::string::npos, bullet.out);
  const Answer beside = run({"gate", file, "stone", "--engine", "ode", "--out", out});
  BOOST_TEST(beside.code == 0, beside.out);
  BOOST_TEST(beside.out.find("no gate judged air/stone") != std::string::npos, beside.out);
}

BOOST_AUTO_TEST_CASE(a_case_that_is_shorter_than_a_step_is_left_out_of_a_suite_and_refused_by_name) {
  std::string text = test::text_with("1");
  text.replace(text.find("duration = 1"), 12, "duration = 0.2");
  folder.write("suite/air/short.toml", text);
  const std::vector<std::string> step = {"--engine", "core:rk4", "--dt", "1/4", "--out", out};
  const auto with = [&](std::vector<std::string> words) {
    words.insert(words.end(), step.begin(), step.end());
    return run(words);
  };
  const Answer whole = with({"run"});
  BOOST_TEST(whole.code == 0, whole.err);
  BOOST_TEST(whole.err.find("left out: air/short: a step of 1/4 s is longer than the run") != std::string::npos,
             whole.err);
  BOOST_TEST(whole.out.find("air/stone") != std::string::npos, whole.out);
  BOOST_TEST(with({"run", "air/short", "air/stone"}).code == 2);
  fs::remove(folder.path / "suite/air/stone.toml"), fs::remove(folder.path / "suite/air/strict.toml");
  BOOST_TEST(with({"run"}).code == 2);
}

// Limits are of a case's own duration, and what is recorded was measured over it.
BOOST_AUTO_TEST_CASE(a_gate_over_another_duration_says_so) {
  const Answer answer = run({"gate", "stone", "--engine", "core:rk4", "--duration", "0.5", "--out", out});
  BOOST_TEST(answer.code == 0, answer.out);
  BOOST_TEST(answer.err.find("held here against 0.5 s") != std::string::npos, answer.err);
}

BOOST_AUTO_TEST_CASE(a_gate_over_what_no_gate_judges_is_refused) {
  const std::string text = test::text_with("1");
  const std::string file = folder.write("open.toml", text.substr(0, text.find("[[gate]]")));
  const Answer answer = run({"gate", file, "--out", out});
  BOOST_TEST(answer.code == 2);
  BOOST_TEST(answer.err.find("nothing to judge") != std::string::npos, answer.err);
  BOOST_TEST(!fs::exists(out));
  const Answer beside = run({"gate", file, "stone", "--engine", "core:rk4", "--out", out});
  BOOST_TEST(beside.code == 0, beside.err);
  BOOST_TEST(beside.err.find("no gate judges ") != std::string::npos, beside.err);
}

BOOST_AUTO_TEST_CASE(a_gate_runs_what_its_gates_judge_and_on_a_runner_points_at_them) {
  const std::string summary = folder.write("summary.md", "before\n");
  ::setenv("GITHUB_ACTIONS", "true", 1), ::setenv("GITHUB_STEP_SUMMARY", summary.c_str(), 1);
  const Answer answer = run({"gate", "--out", out});
  ::unsetenv("GITHUB_ACTIONS"), ::unsetenv("GITHUB_STEP_SUMMARY");
  BOOST_TEST(answer.code == 1);
  BOOST_TEST(answer.out.find("::error file=air/strict.toml,line=") != std::string::npos, answer.out);
  BOOST_TEST(content(summary).starts_with("before\n"));
  BOOST_TEST(content(summary).find("air/strict") != std::string::npos);
  const auto json = nlohmann::json::parse(content(fs::path(out) / "results.json"));
  BOOST_TEST(json.at("cells").size() == 4u);  // of core:rk4, in two cases at two steps
  BOOST_TEST(content(fs::path(out) / "junit.xml").find("failures=\"2\"") != std::string::npos);
}

BOOST_AUTO_TEST_CASE(a_known_deviation_beside_an_adapter_lets_the_gate_hold) {
  const std::string row =
      "[[deviation]]\ncase = \"air/strict\"\ngate = \"position_error\"\n"
      "engines = [\"core:rk4\"]\nreason = \"no run is so exact\"\n";
  folder.write("deviations/core/known_deviations.toml", row);
  const std::string deviations = (folder.path / "deviations").string();
  BOOST_TEST(run({"gate", "--deviations", deviations, "--out", out}).code == 0);
  folder.write("deviations/core/known_deviations.toml",
               row.substr(0, row.find("strict")) + "stone" + row.substr(row.find("strict") + 6));
  const Answer unexpected = run({"gate", "stone", "--deviations", deviations, "--out", out});
  BOOST_TEST(unexpected.code == 1);
  BOOST_TEST(unexpected.out.find("take the row out") != std::string::npos, unexpected.out);
}

BOOST_AUTO_TEST_CASE(compare_answers_with_its_exit_code_and_reads_its_own_baseline) {
  run({"run", "--engine", "core:rk4", "--out", out});
  const std::string results = (fs::path(out) / "results.json").string();
  const Answer baseline = run({"baseline", results});
  BOOST_TEST(baseline.code == 0);
  const std::string kept = folder.write("baseline.txt", baseline.out);
  const Answer same = run({"compare", kept, results});
  BOOST_TEST(same.code == 0);
  BOOST_TEST(same.out.find("nothing changed") != std::string::npos, same.out);
  run({"run", "stone", "--engine", "core:rk4", "--out", out});
  const Answer gone = run({"compare", kept, results});
  BOOST_TEST(gone.code == 1);
  BOOST_TEST(gone.out.find("air/strict") != std::string::npos, gone.out);
}

BOOST_AUTO_TEST_CASE(a_cell_out_of_time_ends_the_run_with_3) {
  const Answer answer = run({"run", "stone", "--engine", "core:rk4", "--dt", "1e-8", "--timeout", "0.2", "--out", out});
  BOOST_TEST(answer.code == 3);
  BOOST_TEST(answer.out.find("timed-out") != std::string::npos, answer.out);
}

BOOST_AUTO_TEST_CASE(a_truth_that_does_not_fit_is_bad_input) {
  std::string text = text_with("1");
  text.replace(text.find("projectile"), 10, "bounce");  // nothing there to bounce on
  const std::string file = folder.write("elsewhere.toml", text);
  const Answer answer = run({"run", file, "--engine", "core:rk4", "--out", out});
  BOOST_TEST(answer.code == 2);
  BOOST_TEST(answer.err.find("elsewhere.toml:14:") != std::string::npos, answer.err);
}

BOOST_AUTO_TEST_CASE(trace_prints_the_run_from_its_start) {
  const Answer answer = run({"trace", "stone", "--engine", "core:rk4", "--dt", "1/10"});
  const auto lines = lines_of(answer.out);
  BOOST_TEST(answer.code == 0);
  BOOST_TEST_REQUIRE(lines.size() == 12u);
  BOOST_TEST(lines[0] == "time,body,px,py,pz,qw,qx,qy,qz,vx,vy,vz,wx,wy,wz");
  BOOST_TEST(lines[1].starts_with("0,\"stone, big\",0,0,0,1,0,0,0,1,0,0,"), lines[1]);
  BOOST_TEST(std::abs(from_the_end(lines[11], 11) - -5) < 1e-12);  // y after 1 s; RK4 is exact but for rounding
  BOOST_TEST(lines_of(run({"trace", "stone", "--engine", "core:rk4", "--dt", "1/10", "--every", "5"}).out).size() ==
             4u);
  BOOST_TEST(lines_of(run({"trace", "stone", "--engine", "ode", "--dt", "1/10", "--duration", "0.5"}).out).size() ==
             7u);
}

// More steps than a judged run keeps: none may be left out, nor may --every count others.
BOOST_AUTO_TEST_CASE(a_long_trace_has_each_nth_step_or_is_refused) {
  const auto traced = [&](const std::string& dt, const std::string& every) {
    return run({"trace", "stone", "--engine", "core:rk4", "--dt", dt, "--every", every});
  };
  const auto lines = lines_of(traced("2.5e-7", "100000").out);
  BOOST_TEST_REQUIRE(lines.size() == 42u);
  BOOST_TEST((lines[2].starts_with("0.025") || lines[2].starts_with("0.02499999")), lines[2]);
  const Answer refused = traced("1e-8", "1");
  BOOST_TEST(refused.code == 2);
  BOOST_TEST(refused.err.find("allowed: --every 3") != std::string::npos, refused.err);
}

BOOST_AUTO_TEST_CASE(truth_prints_states_at_any_time_with_their_error) {
  const Answer answer = run({"truth", "stone", "--times", "0,1/2,3"});
  const auto lines = lines_of(answer.out);
  BOOST_TEST(answer.code == 0);
  BOOST_TEST_REQUIRE(lines.size() == 4u);
  BOOST_TEST(lines[0].ends_with(",wz,error"));
  BOOST_TEST(answer.err.find("a closed form, independent of every engine") != std::string::npos);
  BOOST_TEST(std::abs(from_the_end(lines[2], 12) - -1.25) < 1e-12);
  BOOST_TEST(std::abs(from_the_end(lines[3], 12) - -45) < 1e-12);
  BOOST_TEST(from_the_end(lines[3], 0) < 1e-9);
  BOOST_TEST(lines_of(run({"truth", "stone"}).out).size() == 12u);  // every coarsest step of the run
}

BOOST_AUTO_TEST_CASE(a_reader_that_stops_reading_is_no_fault) {
  const std::string command = std::string("bash -o pipefail -c '") + RIGOR_PROGRAM + " trace stone --suite " + suite +
                              " --engine core:rk4 --dt 1e-5 2>" + (folder.path / "stderr").string() +
                              " | head -n 1 >/dev/null'";
  BOOST_TEST(std::system(command.c_str()) == 0);
  BOOST_TEST(content(folder.path / "stderr") == "");
}

// What is answered does not hang on whether anyone reads it, or on which streams there are.
BOOST_AUTO_TEST_CASE(no_reader_and_no_stream_is_needed_for_the_exit_code) {
  const std::string good = "gate stone --engine core:rk4", bad = "gate strict --engine core:rk4";
  for (const char* around :
       {"%s | true", "%s 2>&1 | true", "%s >&-", "%s <&- >&-", "%s >&- 2>&-", "%s <&- >&- 2>&-", "%s <&- >/dev/null",
        "%s 2>&- >/dev/null", "%s <&- 2>&- >/dev/null", "%s 2>/dev/full >/dev/null"}) {
    BOOST_TEST(shell(around, bad) == 1, around);
    BOOST_TEST(shell(around, good) == 0, around);
    for (const auto& cell : cells()) BOOST_TEST(cell.at("status") == "pass", around);
  }
  BOOST_TEST(shell("%s >&- 2>&-", "gate stone --engine nothing") == 2);
  BOOST_TEST(shell("%s 2>/dev/full", "gate stone --engine nothing") == 2);
  BOOST_TEST(shell("%s >/dev/full 2>/dev/null", good) == 3);  // it can be opened, but nothing can be written
}

BOOST_AUTO_TEST_CASE(what_a_terminal_would_obey_is_not_printed) {
  const std::string nasty = "a\x1b[31m\x07\x9b\xc2\x9b\x7f b";
  for (const std::vector<std::string>& words : {std::vector<std::string>{"run", nasty},
                                                {nasty},
                                                {"run", "--" + nasty},
                                                {"list", nasty},
                                                {"run", "stone", "--engine", nasty},
                                                {"run", "stone", "--out", out, "--jobs", nasty}}) {
    const Answer answer = run(words);
    BOOST_TEST(answer.code == 2);
    BOOST_TEST(answer.err.find_first_of("\x1b\x07\x7f\x9b") == std::string::npos, answer.err);
    BOOST_TEST(answer.err.find("a\\x1b[31m\\x07\\x9b\\xc2\\x9b\\x7f b") != std::string::npos, answer.err);
  }
}

BOOST_AUTO_TEST_CASE(tables_are_as_wide_as_the_terminal) {
  ::setenv("COLUMNS", "60", 1);
  const Answer ran = run({"run", "stone", "--engine", "core:rk4", "--out", out}), listed = run({"list"}),
               help = run({"run", "--help"});
  ::unsetenv("COLUMNS");
  for (const Answer& answer : {ran, help, listed}) {
    for (const std::string& line : lines_of(answer.out)) {
      const bool is_one_word = line.find(' ', line.find_first_not_of(' ')) == std::string::npos;
      const bool is_example = line.starts_with("  rigor ");
      BOOST_TEST((line.size() <= 60 || is_one_word || is_example), line);
    }
  }
}

BOOST_AUTO_TEST_CASE(one_run_and_one_step_are_run_once_however_they_are_written) {
  const Answer answer = run({"run", "stone", "--engine", "ode", "--engine", "ode:auto", "--engine", "ode@matched",
                             "--dt", "1/10", "--dt", "0.1", "--dt", "0.100000000000001", "--out", out});
  BOOST_TEST(answer.code == 0);
  BOOST_TEST(results().at("cells").size() == 1u);
}

BOOST_AUTO_TEST_CASE(numbers_of_any_size_do_not_lose_the_run) {
  std::string text = text_with("1");
  text.replace(text.find("[0, -10, 0]"), 11, "[1e-320, -10, 0]");
  const std::string file = folder.write("subnormal.toml", text);
  const Answer answer = run({"run", file, "--engine", "core:rk4", "--out", out});
  BOOST_TEST(answer.code == 0, answer.err);
  BOOST_TEST(results().at("cells").size() == 2u);
}

BOOST_AUTO_TEST_SUITE_END()
