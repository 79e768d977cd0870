// rigor run and rigor gate: run a grid, write its reports and return its exit code. Or run one shard for `rigor merge`.
#include <fmt/format.h>

#include <algorithm>

#include "cases/cli/grid_run.h"
#include "cases/cli/options.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/plan_sentence.h"
#include "cases/cli/progress/progress.h"
#include "cases/cli/progress/time_left.h"
#include "cases/runner/ensemble.h"
#include "cases/runner/shards/part.h"

namespace rigor {
namespace {

std::size_t cells_to_run(const CaseResult& result) {
  return static_cast<std::size_t>(std::count_if(result.cells.begin(), result.cells.end(),
                                                [](const Cell& cell) { return cell.status != Status::unsupported; }));
}

void run_with_progress(Results& grid, const EngineTable& engines, GridOptions options, const CommandLine& line) {
  const bool speaks = !options.executor || options.executor->leads();
  for (const CaseResult& result : speaks ? grid.cases : std::vector<CaseResult>()) {
    const std::string cost = cost_of_ensemble(result.definition, cells_to_run(result));
    if (!cost.empty()) say(cost);
  }
  Progress progress;
  TimeLeft left(grid, line.jobs, measured_times(line.out));
  options.on_part = [&](std::size_t of_case, const MessageSubject& subject) {
    if (subject.part == MessageSubject::Part::cell)
      left.end_cell(of_case, subject.index, grid.cases[of_case].cells[subject.index].wall_seconds);
    if (subject.part == MessageSubject::Part::stable_step) left.end_search(of_case, subject.index);
  };
  // Processes of an executor are counted elsewhere, so their rate is not known.
  if (!options.executor) progress.estimate_with([&](double seconds) { return left.at(seconds); });
  run_grid(grid, engines, options, [&](std::size_t done, std::size_t all) { progress.show(done, all); });
}

int run_whole(const CommandLine& line, const EngineTable& engines) {
  GridRun run = plan_run(line, engines);
  OutputFolder folder = output_folder_of(line);
  if (leads(line)) say(plan_sentence(run.grid, line));
  bool is_whole = false;
  try {
    run_with_progress(run.grid, engines, options_of(run, folder), line);
    judge(run);
    is_whole = write_reports(run.grid, folder);
  } catch (...) {  // Interrupted, too
    folder.keep();
    throw;
  }
  return answer(run, is_whole);
}

// The number of cells of this shard, and their results.
std::string summary_of(const CommandLine& line, const Results& share) {
  std::map<std::string, int> counts;
  int all = 0;
  for (const CaseResult& result : share.cases) {
    for (const Cell& cell : result.cells) {
      if (cell.status != Status::unsupported) ++counts[word_of(cell.status)], ++all;
    }
  }
  std::string text = fmt::format("shard {} of {}: {} cells", line.shard.index, line.shard.count, all);
  // Gates are judged with all parts. Before that a cell that passes has only run.
  for (const auto& [word, count] : counts) text += fmt::format(", {} {}", count, word == "pass" ? "ran" : word);
  return text +
         fmt::format("\nThis is one part of the result. To join and judge all {} parts: rigor merge DIR... --out DIR\n",
                     line.shard.count);
}

int run_shard(const CommandLine& line, const EngineTable& engines) {
  GridRun run = plan_run(line, engines);
  OutputFolder folder = output_folder_of(line);
  const GridOptions options = options_of(run, folder);
  const Results planned = share_of(run.grid, line.shard);
  if (leads(line)) say(plan_sentence(planned, line));
  Results share = planned;
  try {
    run_with_progress(share, engines, options, line);
    folder.write(kPartFile, part_text(title_of_part(line, plans_of(run.grid, engines, options), share.wall_seconds),
                                      planned, share, engines, options));
    std::vector<std::string> trajectories;
    for (const CaseResult& result : share.cases) {
      for (const Cell& cell : result.cells) {
        if (!cell.trajectory.empty() && cell.status != Status::unsupported) trajectories.push_back(cell.trajectory);
      }
    }
    folder.publish(trajectories);
  } catch (...) {
    folder.keep();
    throw;
  }
  print_table(summary_of(line, share));
  return ending_of(share, true);
}

int run_or_part(const CommandLine& line, const EngineTable& engines) {
  return line.shard.is_all() ? run_whole(line, engines) : run_shard(line, engines);
}

}  // namespace

static int run_command(const CommandLine& line, const EngineTable& engines) { return run_or_part(line, engines); }

static int gate_command(const CommandLine& line, const EngineTable& engines) { return run_or_part(line, engines); }

CommandRow run_row() {
  return {
      "run",
      "simulate cases, judge the results, print a table and write reports",
      "CASE",
      kCasesOrAll,
      with_import_options({"--deviations", "--dt", "--duration", "--engine", "--jobs", "--out", "--plugin", "--resume",
                           "--shard", "--suite", "--timeout", "--verbose"}),
      {{"rigor run springs/fixed-spring", "one case by every engine; the report is out/report.html"},
       {"rigor run springs --engine ode --engine core:rk4 --dt 1/60", "a family of cases, two engines, one step size"},
       {"rigor run robot.urdf my-case.toml --out robots", "files of your own"}},
      run_command};
}

CommandRow gate_row() {
  return {"gate",
          "run, and exit 1 if a gate does not hold",
          "CASE",
          kCasesOrAll,
          with_import_options({"--deviations", "--dt", "--duration", "--engine", "--jobs", "--out", "--plugin",
                               "--quick", "--resume", "--shard", "--suite", "--timeout", "--verbose"}),
          {{"rigor gate --quick", "for each change: the fast gates of the whole suite"},
           {"rigor gate --engine bullet", "all gates of one engine"},
           {"rigor gate springs --plugin ./my_engine.so", "an engine of your own against one family"}},
          gate_command};
}

}  // namespace rigor
