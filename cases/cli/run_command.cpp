// rigor run and rigor gate: the grid, its reports, its exit code.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>

#include "cases/case/run_selector.h"
#include "cases/case/suite.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/progress.h"
#include "cases/gates/deviations.h"
#include "cases/gates/gates.h"
#include "cases/gates/quick.h"
#include "cases/report/console/console_table.h"
#include "cases/report/github/job_summary.h"
#include "cases/report/reports.h"
#include "cases/runner/grid.h"
#include "cases/runner/output_folder.h"
#include "cases/runner/process_pool.h"
#include "core/base/error.h"

namespace rigor {
namespace {

std::vector<RunName> runs_asked_for(const CommandLine& line) {
  const auto infos = infos_of(engines());
  if (line.engines.empty()) return default_runs(infos);
  std::vector<RunName> runs;
  for (const std::string& name : line.engines) {
    RunName run = parse_run_name(name, infos);
    const auto is_it = [&](const RunName& other) { return other.text == run.text; };
    if (std::none_of(runs.begin(), runs.end(), is_it)) runs.push_back(std::move(run));
  }
  return runs;
}

// A gate wants what its gates judge, and no more than that unless engines or steps are named.
bool is_gate(const CommandLine& line) { return line.command == "gate"; }

Results planned(const CommandLine& line, const std::vector<KnownDeviation>& deviations) {
  std::vector<Case> cases = select_cases(line.words, line.suite_dir);
  if (line.dt.empty() && !line.duration) check_known_deviations(deviations, cases, infos_of(engines()));
  for (Case& definition : cases) override_run(definition, {line.dt, line.duration});
  if (line.quick) cases = quick_selection(cases, infos_of(engines()));
  const std::vector<RunName> runs = runs_asked_for(line);
  // Who names engines wants these and no others.
  const auto of_gates = line.engines.empty() ? runs_of_gates(cases, runs, infos_of(engines())) : std::vector<RunName>();
  const Scope scope{!is_gate(line), is_gate(line) && line.engines.empty() && line.dt.empty()};
  return plan_grid(cases, runs, engines(), scope, of_gates);
}

Results simulated_and_written(const CommandLine& line) {
  const auto deviations = read_known_deviations(line.adapters_dir, infos_of(engines()));
  const RecordedValues recorded = read_recorded_values(line.adapters_dir, infos_of(engines()));
  Results grid = planned(line, deviations);
  std::vector<std::string> file_names;
  for (const ReportRow& report : reports()) file_names.push_back(report.file_name);
  OutputFolder folder(line.out, file_names, line.resume);
  try {
    Progress progress;
    run_grid(grid, engines(),
             {line.jobs, line.limit, folder.trajectories(), !is_gate(line), !is_gate(line), folder.journals()},
             [&](std::size_t done, std::size_t all) { progress.show(done, all); });
  } catch (const Interrupted&) {
    folder.keep();
    throw;
  }
  std::vector<std::string> trajectories;
  for (CaseResult& result : grid.cases) {
    check_gates(result, grid, recorded);
    apply_known_deviations(result, grid, deviations);
    for (const Cell& cell : result.cells) trajectories.push_back(cell.trajectory);
  }
  for (const ReportRow& report : reports()) folder.write(report.file_name, report.write(grid));
  folder.publish(trajectories);
  return grid;
}

// A cell that crashed or ran out of time. The search for a stable step may take longer than it is given, which leaves a
// gap in the table and says nothing against an engine; a crash in it does.
bool something_broke(const Results& grid) {
  return std::any_of(grid.cases.begin(), grid.cases.end(), [](const CaseResult& result) {
    return std::any_of(
               result.cells.begin(), result.cells.end(),
               [](const Cell& cell) { return cell.status == Status::crashed || cell.status == Status::timed_out; }) ||
           std::any_of(result.stable_steps.begin(), result.stable_steps.end(),
                       [](const StableStepResult& stable) { return stable.status == Status::crashed; });
  });
}

// What `run` answers with, gates aside.
int ending_of(const Results& grid) {
  for (const CaseResult& result : grid.cases) {
    if (result.error_is_input) return fmt::print(stderr, "rigor: {}\n", result.error), kBadInput;
  }
  return something_broke(grid) ? kBroken : kGood;
}

// On a GitHub runner: annotations on stdout, where it looks for them, and the job's summary.
void tell_the_runner(const Results& grid, const std::vector<Shortfall>& rows) {
  const char *is_one = std::getenv("GITHUB_ACTIONS"), *summary = std::getenv("GITHUB_STEP_SUMMARY");
  if (is_one && std::string(is_one) == "true") print(annotations(rows));
  if (!summary || !*summary) return;
  std::ofstream file(summary, std::ios::binary | std::ios::app);
  file << job_summary(grid);
  file.close();
  if (!file) fmt::print(stderr, "rigor: the job's summary could not be written to '{}'\n", summary);
}

// Of the whole suite each gate of a family has to meet something; of a part of it, another part may be meant.
std::vector<Shortfall> unmet_of_whole_suite(const CommandLine& line, const Results& grid) {
  std::vector<Shortfall> rows;
  if (!line.words.empty() || !line.engines.empty() || !line.dt.empty() || line.quick) return rows;
  for (const Gate& gate : unmet_family_gates(grid))
    rows.push_back(
        {"the suite", "", "", gate.metric, "", "", "", "no cell of any case has it for this gate", gate.where});
  return rows;
}

}  // namespace

int run_command(const CommandLine& line) {
  const Results grid = simulated_and_written(line);
  const int ending = ending_of(grid);
  print(console_table(grid));
  return ending;
}

int gate_command(const CommandLine& line) {
  const Results grid = simulated_and_written(line);
  const int ending = ending_of(grid);
  std::vector<Shortfall> rows = shortfalls(grid);
  const std::vector<Shortfall> unmet = unmet_of_whole_suite(line, grid);
  rows.insert(rows.end(), unmet.begin(), unmet.end());
  print(console_table(grid) + gate_summary(grid) + shortfalls_text(rows));
  tell_the_runner(grid, rows);
  return ending == kGood && !(all_gates_hold(grid) && unmet.empty()) ? int{kGateFailed} : ending;
}

}  // namespace rigor
