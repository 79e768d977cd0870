#include "cases/cli/grid_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "cases/case/run_selector.h"
#include "cases/case/selection.h"
#include "cases/cli/chosen_cases.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/progress.h"
#include "cases/cli/progress/time_left.h"
#include "cases/cli/vocabulary.h"
#include "cases/gates/failures.h"
#include "cases/gates/quick.h"
#include "cases/report/console/console_table.h"
#include "cases/report/github/job_summary.h"
#include "cases/report/json/machine.h"
#include "cases/report/reports.h"
#include "cases/report/wording/printed_command.h"
#include "cases/runner/build_identity.h"
#include "cases/runner/ensemble.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor::inline cli {
namespace {

// A case without a gate must not look like one that passed.
void expect_gates(const std::vector<Case>& cases) {
  std::vector<std::string> without;
  for (const Case& definition : cases) {
    if (definition.gates.empty()) without.push_back(definition.id);
  }
  if (without.size() == cases.size()) {
    throw InputError(fmt::format("rigor gate: there is no gate in {}, so there is nothing to judge; use rigor run",
                                 fmt::join(without, ", ")));
  }
  if (!without.empty()) say(fmt::format("no gate judges {}", fmt::join(without, ", ")));
}

void tell_of_duration(double duration) {
  say(fmt::format("the gates' limits are made for the cases' own durations, and are held here against {} s", duration));
}

std::vector<RunName> without_those_on_request(std::vector<RunName> runs) {
  std::erase_if(runs, [](const RunName& run) { return is_on_request(run.engine); });
  return runs;
}

// A line below the table that names engines which run only if they are named.
std::string left_out_text(const GridRun& run) {
  const std::string names = left_out_by_default(run.asked.engines, run.engines.infos());
  return names.empty() ? "" : fmt::format("on request (--engine NAME): {}\n", names);
}

Results planned(const GridRequest& asked, const EngineTable& engines, const std::vector<KnownDeviation>& deviations) {
  const Overrides overrides{asked.steps.dt, asked.duration.seconds};
  std::vector<Case> cases = overridden_cases(asked.cases, asked.invocation, overrides, vocabulary_of(engines.infos()));
  if (overrides.dt.empty() && !overrides.duration) check_known_deviations(deviations, cases, engines.infos());
  if (asked.is_quick) cases = quick_selection(cases, engines.infos());
  if (asked.is_gate) expect_gates(cases);
  if (asked.is_gate && overrides.duration) tell_of_duration(*overrides.duration);
  const std::vector<RunName> runs = runs_asked_for(asked.engines, engines.infos());
  const bool names_engines = !asked.engines.engines.empty();
  // Named engines run alone.
  const auto of_gates =
      names_engines ? std::vector<RunName>() : without_those_on_request(runs_of_gates(cases, runs, engines.infos()));
  const Scope scope{!asked.is_gate, asked.is_gate && !names_engines && overrides.dt.empty()};
  return plan_grid(cases, runs, engines, scope, of_gates);
}

std::string text_of_report(const ReportRow& report, const Results& grid, const ReportAdditions& added) {
  std::string text = report.write(grid);
  return report.name == "html" && added.on_page ? added.on_page(text) : text;
}

// The files of every cell that has any.
std::vector<std::string> trajectories_in(const Results& grid) {
  std::vector<std::string> trajectories;
  for (const CaseResult& result : grid.cases) {
    for (const Cell& cell : result.cells) {
      if (!cell.trajectory.empty() && cell.status != Status::unsupported) trajectories.push_back(cell.trajectory);
      const auto series = cell.recordings.find("series");
      if (series != cell.recordings.end())
        trajectories.insert(trajectories.end(), series->second.begin(), series->second.end());
    }
  }
  return trajectories;
}

// Whether a cell crashed or ran out of time. A search for the stable step may run out of time, but must not crash.
bool something_broke(const Results& grid) {
  return std::any_of(grid.cases.begin(), grid.cases.end(), [](const CaseResult& result) {
    return std::any_of(
               result.cells.begin(), result.cells.end(),
               [](const Cell& cell) { return cell.status == Status::crashed || cell.status == Status::timed_out; }) ||
           std::any_of(result.stable_steps.begin(), result.stable_steps.end(),
                       [](const StableStepResult& stable) { return stable.status == Status::crashed; });
  });
}

// On a GitHub runner, prints annotations on stdout and appends to the job's summary.
void tell_the_runner(const Results& grid, const std::vector<Failure>& rows) {
  const char *is_one = std::getenv("GITHUB_ACTIONS"), *summary = std::getenv("GITHUB_STEP_SUMMARY");
  if (is_one && std::string(is_one) == "true") print_table(annotations(rows) + warnings(grid));
  if (!summary || !*summary) return;
  std::ofstream file(summary, std::ios::binary | std::ios::app);
  file << job_summary(grid);
  file.close();
  if (!file) say(fmt::format("the job's summary could not be written to '{}'", summary));
}

// In a run of the whole suite, each gate of a family must have a cell that it judges.
std::vector<Failure> unmet_of_whole_suite(const GridRequest& asked, const Results& grid) {
  std::vector<Failure> rows;
  const bool is_whole = asked.cases.words.empty() && asked.engines.engines.empty() && asked.steps.dt.empty();
  if (!is_whole || asked.is_quick) return rows;
  for (const Gate& gate : unmet_family_gates(grid))
    rows.push_back(
        {"the suite", "", "", gate.metric, "", "", "", "no cell of any case has it for this gate", gate.where});
  return rows;
}

// The command that diagnoses the first failure of a run. Empty if there is none.
std::string diagnose_text(const std::vector<Failure>& rows) {
  const auto of_run = std::find_if(rows.begin(), rows.end(), [](const Failure& row) { return !row.engine.empty(); });
  return of_run == rows.end() ? "" : diagnose_command_text(of_run->case_id, of_run->engine);
}

Detail detail_of(const GridRequest& asked) { return asked.is_verbose ? Detail::full : Detail::brief; }

int answer_of_gate(const GridRun& run, int ending) {
  std::vector<Failure> rows = failures(run.grid);
  const std::vector<Failure> unmet = unmet_of_whole_suite(run.asked, run.grid);
  rows.insert(rows.end(), unmet.begin(), unmet.end());
  print_table(console_table(run.grid, detail_of(run.asked)) + left_out_text(run) + gate_summary(run.grid) +
              failures_text(rows, diagnose_text(rows)));
  tell_the_runner(run.grid, rows);
  return ending == kGood && !(all_gates_hold(run.grid) && unmet.empty()) ? int{kGateFailed} : ending;
}

std::size_t cells_to_run(const CaseResult& result) {
  return static_cast<std::size_t>(std::count_if(result.cells.begin(), result.cells.end(),
                                                [](const Cell& cell) { return cell.status != Status::unsupported; }));
}

}  // namespace

void GridRequest::declare(Options& options) {
  cases.declare(options), engines.declare(options), steps.declare(options), duration.declare(options);
  jobs.declare(options), timeout.declare(options), out.declare(options), resume.declare(options);
  shard.declare(options), deviations.declare(options);
  options.add_flag("--verbose", "print every table and every reason", is_verbose);
  options.add_flag("--series", "write each metric over time beside the trajectories", has_series);
  if (is_gate) options.add_flag("--quick", "check only gates whose cells are fast", is_quick);
}

RunName run_of_option(const std::string& value, const std::vector<EngineInfo>& infos) {
  const std::string engine = value.substr(0, value.find_first_of(":,@"));
  const auto has_name = [&](const auto& row) { return row.name == engine; };
  const auto missing = std::find_if(missing_engines().begin(), missing_engines().end(), has_name);
  if (missing != missing_engines().end() && std::none_of(infos.begin(), infos.end(), has_name))
    throw InputError(fmt::format("--engine: {} is {}", engine, missing->how));
  try {
    return parse_run_name(value, infos);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--engine: {}", error.what()));
  }
}

std::vector<RunName> runs_asked_for(const EngineOptions& options, const std::vector<EngineInfo>& infos) {
  if (options.engines.empty()) return without_those_on_request(default_runs(infos));
  std::vector<RunName> runs;
  for (const std::string& name : options.engines) {
    RunName run = run_of_option(name, infos);
    const auto is_it = [&](const RunName& other) { return is_same_run(other, run); };
    if (std::none_of(runs.begin(), runs.end(), is_it)) runs.push_back(std::move(run));
  }
  return runs;
}

std::string left_out_by_default(const EngineOptions& options, const std::vector<EngineInfo>& infos) {
  std::vector<std::string> names;
  for (const EngineInfo& info : infos) {
    if (options.engines.empty() && is_on_request(info.name)) names.push_back(info.name);
  }
  return listed(names);
}

GridRun plan_run(const GridRequest& asked, const EngineTable& engines) {
  auto deviations = read_known_deviations(asked.deviations.dir, engines.infos());
  RecordedValues recorded = read_recorded_values(asked.deviations.dir, engines.infos());
  if (asked.duration.seconds) recorded = {};  // of runs of other lengths
  Results grid = planned(asked, engines, deviations);
  return {asked, engines, std::move(deviations), std::move(recorded), std::move(grid)};
}

GridRun plan_runs_of(const Case& definition, const std::vector<RunName>& runs, const GridRequest& asked,
                     const EngineTable& engines) {
  RecordedValues recorded = read_recorded_values(asked.deviations.dir, engines.infos());
  if (asked.duration.seconds) recorded = {};  // of runs of other lengths
  return {asked, engines, read_known_deviations(asked.deviations.dir, engines.infos()), std::move(recorded),
          plan_grid({definition}, runs, engines, Scope{.stable_steps = false, .only_judged = false})};
}

OutputFolder output_folder_of(const GridRequest& asked) {
  if (!asked.invocation.leads()) return OutputFolder::of_helper(asked.out.dir);
  std::vector<std::string> files = report_files();
  files.insert(files.end(), {kPartFile, kDivergenceFile});
  return OutputFolder(asked.out.dir, files, asked.resume.is_on);
}

GridOptions options_of(const GridRun& run, const OutputFolder& folder) {
  const bool is_run = !run.asked.is_gate;
  return {run.asked.jobs.count,
          run.asked.timeout.seconds,
          recorders_for(run.grid, folder.trajectories(), run.asked.has_series),
          is_run,
          is_run,
          folder.journals(),
          run.asked.invocation.executor};
}

PartTitle title_of_part(const Invocation& invocation, const Shard& shard, const std::string& suite,
                        const std::string& deviations, std::vector<std::pair<std::string, std::string>> plans,
                        double wall_seconds) {
  const auto whole = [](const std::string& path) {
    std::error_code error;
    return std::filesystem::absolute(path, error).lexically_normal().string();
  };
  return {shard,
          this_machine().program_version,
          build_identity(),
          invocation.arguments,
          whole(suite),
          whole(deviations),
          std::move(plans),
          wall_seconds};
}

std::vector<std::string> report_files() {
  std::vector<std::string> names;
  for (const ReportRow& report : reports()) names.push_back(report.file_name);
  return names;
}

void run_with_progress(Results& grid, const EngineTable& engines, GridOptions options, const GridRequest& asked) {
  const bool speaks = !options.executor || options.executor->leads();
  for (const CaseResult& result : speaks ? grid.cases : std::vector<CaseResult>()) {
    const std::string cost = cost_of_ensemble(result.definition, cells_to_run(result));
    if (!cost.empty()) say(cost);
  }
  Progress progress;
  TimeLeft left(grid, asked.jobs.count, measured_times(asked.out.dir));
  options.on_part = [&](std::size_t of_case, const MessageSubject& subject) {
    if (subject.part == MessageSubject::Part::cell)
      left.end_cell(of_case, subject.index, grid.cases[of_case].cells[subject.index].wall_seconds);
    if (subject.part == MessageSubject::Part::stable_step) left.end_search(of_case, subject.index);
  };
  // Processes of an executor are counted elsewhere, so their rate is not known.
  if (!options.executor) progress.estimate_with([&](double seconds) { return left.at(seconds); });
  run_grid(grid, engines, options, [&](std::size_t done, std::size_t all) { progress.show(done, all); });
}

// Gates of other runs or steps than those named are not checked. If then no gate judged anything, all are checked, so
// that the gate fails.
void judge(GridRun& run) {
  const auto check = [&](Asked asked) {
    for (CaseResult& result : run.grid.cases) {
      check_gates(result, run.grid, run.recorded, asked);
      apply_known_deviations(result, run.grid, run.deviations);
    }
  };
  check(run.asked.engines.engines.empty() && run.asked.steps.dt.empty() ? Asked::all : Asked::some);
  if (run.asked.is_gate && !is_any_judged(run.grid)) check(Asked::all);
}

bool write_reports(const Results& grid, OutputFolder& folder, const ReportAdditions& added) {
  std::vector<OutputFile> files;
  for (const ReportRow& report : reports())
    files.push_back({report.file_name, [&] { return text_of_report(report, grid, added); }});
  for (const auto& [file, text] : added.files) files.push_back({file, [&content = text] { return content; }});
  const auto faults = faults_of_writing(folder, files, trajectories_in(grid), added.can_resume);
  for (const std::string& fault : faults) say(fault);
  return faults.empty();
}

int ending_of(const Results& grid, bool is_whole) {
  for (const CaseResult& result : grid.cases) {
    if (result.error_is_input) return say(result.error), kBadInput;
  }
  int ending = is_whole && !something_broke(grid) ? kGood : kBroken;
  for (const CaseResult& result : grid.cases) {
    if (!result.error.empty()) say(fmt::format("{}: {}", result.definition.id, result.error)), ending = kBroken;
  }
  return ending;
}

int answer(const GridRun& run, bool is_whole) {
  const int ending = ending_of(run.grid, is_whole);
  if (run.asked.is_gate) return answer_of_gate(run, ending);
  print_table(console_table(run.grid, detail_of(run.asked)) + left_out_text(run));
  return ending;
}

}  // namespace rigor::inline cli
