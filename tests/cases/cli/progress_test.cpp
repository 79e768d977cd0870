// What is said of how far a command is, and of how long it takes.
#include "cases/cli/progress/progress.h"

#include <boost/test/unit_test.hpp>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <regex>

#include "cases/cli/progress/durations.h"
#include "cases/cli/progress/measured_times.h"
#include "cases/cli/progress/time_left.h"
#include "tests/cases/cli/program.h"

using namespace rigor;

BOOST_AUTO_TEST_SUITE(cases_cli_progress)
using Json = nlohmann::json;

namespace {

std::size_t lines_with(const std::string& text, const std::string& pattern) {
  const std::regex wanted(pattern);
  return static_cast<std::size_t>(std::distance(std::sregex_iterator(text.begin(), text.end(), wanted), {}));
}

// So that a test need not wait for ten seconds.
struct Quick : Program {
  Quick() { setenv("RIGOR_PROGRESS_SECONDS", "0.001", 1), folder.write("stone.toml", kThrown); }
  ~Quick() { unsetenv("RIGOR_PROGRESS_SECONDS"); }
};

}  // namespace

BOOST_AUTO_TEST_CASE(durations_are_rounded_and_ranges_never_promise_too_little) {
  BOOST_TEST(duration_text(0.4) == "0 s");
  BOOST_TEST(duration_text(42.4) == "42 s");
  BOOST_TEST(duration_text(100) == "2 minutes");
  BOOST_TEST(duration_text(3600) == "60 minutes");
  BOOST_TEST(duration_text(7200) == "2 hours");
  BOOST_TEST(duration_range(3.2, 7.1) == "3 to 8 s");
  BOOST_TEST(duration_range(21, 64) == "20 to 70 s");
  BOOST_TEST(duration_range(61, 130) == "60 s to 3 minutes");
  BOOST_TEST(duration_range(130, 250) == "2 to 5 minutes");
  BOOST_TEST(duration_range(0.2, 0.9) == "0 to 1 s");
  BOOST_TEST(duration_range(20, 20) == "20 s");
  BOOST_TEST(duration_range(3600, 3600 * 2.5) == "60 minutes to 3 hours");
}

BOOST_AUTO_TEST_CASE(the_rest_is_at_least_what_the_rate_so_far_leaves) {
  BOOST_TEST(progress_text("cells", 0, 140, 12) == "0 of 140 cells after 12 s");
  BOOST_TEST(progress_text("cells", 35, 140, 40) == "35 of 140 cells after 40 s; 2 to 4 minutes left");
  BOOST_TEST(progress_text("cells", 140, 140, 40) == "140 of 140 cells after 40 s");
  BOOST_TEST(progress_text("runs of ode", 320, 0, 40) == "320 runs of ode after 40 s");
  // An interrupted run had finished 30 of the 35: these took no time now.
  BOOST_TEST(progress_text("cells", 35, 140, 40, 30) == "35 of 140 cells after 40 s; 14 to 28 minutes left");
  BOOST_TEST(progress_text("cells", 30, 140, 40, 30) == "30 of 140 cells after 40 s");
}

// Two engines at one step of a second: "slow" takes ten times the predicted time, "fast" a tenth.
Results planned_for_two(int cells_each) {
  Results grid;
  grid.runs.resize(2);
  grid.runs[0].engine = grid.runs[0].text = "slow", grid.runs[1].engine = grid.runs[1].text = "fast";
  CaseResult result;
  result.definition.id = "stone", result.definition.duration = 1;
  result.definition.scene.bodies.resize(1);
  for (int n = 0; n < 2 * cells_each; ++n) {
    Cell cell;
    cell.run = static_cast<std::size_t>(n % 2), cell.dt = {1e-6, "1e-6"}, cell.status = Status::pass;
    result.cells.push_back(cell);
  }
  grid.cases = {result};
  return grid;
}

// Ten slow cells and thirty fast ones are left. The count alone would let each take as long as those that have ended.
BOOST_AUTO_TEST_CASE(the_time_left_follows_from_each_engines_own_cells) {
  const Results grid = planned_for_two(40);
  const double each = predicted_seconds(grid.cases[0].definition, grid.cases[0].cells[0]);
  TimeLeft left(grid, 2, {});
  double elapsed = 0;
  std::optional<Estimate> said;
  const auto end = [&](std::size_t cell) {
    const double took = cell % 2 == 0 ? 10 * each : each / 10;
    elapsed += took / 2, left.end_cell(0, cell, took), said = left.at(elapsed);
  };
  for (std::size_t n = 0; n < 30; ++n) {  // the slow ones go ahead
    end(2 * n);
    if (n < 10) end(2 * n + 1);
  }
  const double truth = (10 * 10 * each + 30 * each / 10) / 2;
  BOOST_TEST_REQUIRE(said.has_value());
  const double middle = std::sqrt(said->least * said->most);
  BOOST_TEST(middle > truth / 1.5, middle << " s said, " << truth << " s needed");
  BOOST_TEST(middle < truth * 1.5, middle << " s said, " << truth << " s needed");
}

BOOST_AUTO_TEST_CASE(the_time_left_is_not_known_before_a_tenth_is_done_or_while_the_prediction_moves) {
  const Results grid = planned_for_two(40);
  const double each = predicted_seconds(grid.cases[0].definition, grid.cases[0].cells[0]);
  TimeLeft early(grid, 2, {});
  early.end_cell(0, 0, each);
  BOOST_TEST(!early.at(0.5 * each).has_value());
  BOOST_TEST(!early.at(5 * each).has_value());
  TimeLeft moving(grid, 2, {});
  double elapsed = 0;
  for (std::size_t n = 0; n < 20; ++n) {  // each cell takes twice as long as the one before
    const double took = each * std::pow(2.0, static_cast<double>(n));
    elapsed += took, moving.end_cell(0, n, took);
    BOOST_TEST(!moving.at(elapsed).has_value());
  }
  // Cells of an earlier run count with their own time.
  MeasuredTimes measured;
  for (const char* run : {"slow", "fast"}) measured[{"stone", run, "1e-6"}] = 3;
  TimeLeft known(grid, 2, measured);
  for (std::size_t n = 0; n < 40; ++n) known.end_cell(0, n, 3), known.at(1.5 * static_cast<double>(n + 1));
  const auto said = known.at(60);
  BOOST_TEST_REQUIRE(said.has_value());
  BOOST_TEST(said->least <= 60);
  BOOST_TEST(said->most >= 60);
}

BOOST_AUTO_TEST_CASE(a_line_says_when_the_time_left_is_not_known) {
  BOOST_TEST(progress_text("cells", 35, 140, 40, Estimate{130, 250}) ==
             "35 of 140 cells after 40 s; 2 to 5 minutes left");
  BOOST_TEST(progress_text("cells", 35, 140, 40, std::optional<Estimate>()) ==
             "35 of 140 cells after 40 s; the time left is not known yet");
  BOOST_TEST(progress_text("cells", 140, 140, 40, std::optional<Estimate>()) == "140 of 140 cells after 40 s");
}

// A process that no terminal shows is not silent for long, whatever it does.
BOOST_AUTO_TEST_CASE(without_a_terminal_each_long_command_says_how_far_it_is) {
  const Quick program;
  const Program::Answer tuned =
      program.run({"tune", "stone.toml", "--engine", "ode", "--within", "1cm", "--jobs", "2"});
  BOOST_TEST(tuned.code == 0, tuned.err);
  BOOST_TEST(lines_with(tuned.err, "rigor: \\d+ runs of ode after \\d+ s\n") >= 1u, tuned.err);
  const Program::Answer swept = program.run(
      {"sweep", "stone.toml", "--engine", "ode", "--vary", "dt=1/1000..1/10:400", "--jobs", "1", "--out", "swept"});
  BOOST_TEST(swept.code == 0, swept.err);
  BOOST_TEST(swept.err.find("rigor: 400 cells with 1 jobs") != std::string::npos, swept.err);
  BOOST_TEST(lines_with(swept.err, "rigor: \\d+ of 400 cells after \\d+ s; .* left\n") >= 1u, swept.err);
  const Program::Answer found = program.run({"diagnose", "stone.toml", "--engine", "ode", "--jobs", "1"});
  BOOST_TEST(found.code == 0, found.err);
  BOOST_TEST(lines_with(found.err, "rigor: \\d+ motions after \\d+ s\n") >= 1u, found.err);
  const Program::Answer repeated = program.run({"repeat", "stone.toml", "--engine", "ode", "--jobs", "1"});
  BOOST_TEST(repeated.code == 0, repeated.err);
  BOOST_TEST(lines_with(repeated.err, "rigor: \\d+ of \\d+ changes after \\d+ s.*\n") >= 1u, repeated.err);
  const Program::Answer checked = program.run({"conform", "--engine", "ode"});
  BOOST_TEST(checked.code == 0, checked.err);
  BOOST_TEST(lines_with(checked.err, "rigor: \\d+ of \\d+ checks after \\d+ s.*\n") >= 1u, checked.err);
}

// Only of this machine, and only if the file is whole.
BOOST_AUTO_TEST_CASE(an_earlier_run_to_the_same_folder_says_how_long_its_cells_took) {
  const Quick program;
  BOOST_TEST(measured_times(program.path("out")).empty());
  BOOST_TEST(program.run({"run", "stone.toml", "--engine", "ode", "--out", "out"}).code == 0);
  const Json results = Json::parse(program.content("out/results.json"));
  const MeasuredTimes times = measured_times(program.path("out"));
  BOOST_TEST_REQUIRE(times.size() == 1u);
  const double seconds = results.at("cells")[0].at("wall_seconds");
  BOOST_TEST(times.at({"stone.toml", "ode", "1/10"}) == seconds);
  Json slow = results, elsewhere = results;
  slow["cells"][0]["wall_seconds"] = 600;
  program.folder.write("out/results.json", slow.dump());
  const Program::Answer again = program.run({"run", "stone.toml", "--engine", "ode", "--out", "out", "--jobs", "1"});
  BOOST_TEST(again.err.find("; 6 to 16 minutes with 1 job") != std::string::npos, again.err);
  elsewhere["machine"]["cores"] = 4096;
  program.folder.write("out/results.json", elsewhere.dump());
  BOOST_TEST(measured_times(program.path("out")).empty());
  program.folder.write("out/results.json", results.dump().substr(0, 300));
  BOOST_TEST(measured_times(program.path("out")).empty());
}

BOOST_AUTO_TEST_SUITE_END()
