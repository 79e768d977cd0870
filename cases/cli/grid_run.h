// Shared by run, gate and merge: plans a grid, judges it and writes its reports.
#pragma once

#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "cases/cli/commands.h"
#include "cases/gates/deviations.h"
#include "cases/gates/gates.h"
#include "cases/runner/grid.h"
#include "cases/runner/output_folder.h"
#include "cases/runner/shards/part.h"

namespace rigor::inline cli {

// The options of run and gate.
struct GridRequest {
  Invocation invocation;
  bool is_gate = false;  // without named engines or steps, `gate` runs only cells that a gate judges
  CaseWords cases;
  EngineOptions engines;
  StepOption steps;
  DurationOption duration;
  JobsOption jobs;
  TimeoutOption timeout;
  OutOption out;
  ResumeOption resume;
  ShardOption shard;
  DeviationsOption deviations;
  bool is_quick = false, is_verbose = false, has_series = false;

  void declare(Options& options);
};

inline constexpr const char* kDivergenceFile = "divergence.json";  // only `diverge` writes it

struct GridRun {
  const GridRequest& asked;
  const EngineTable& engines;
  std::vector<KnownDeviation> deviations;
  RecordedValues recorded;
  Results grid;
};

// Names the engines that run only if a command line names them. Empty if the options name engines.
std::string left_out_by_default(const EngineOptions& options, const std::vector<EngineInfo>& infos);

// Returns the runs that --engine names, each once. Without --engine: the default runs.
std::vector<RunName> runs_asked_for(const EngineOptions& options, const std::vector<EngineInfo>& infos);

// Plans the grid and runs nothing. Throws InputError.
GridRun plan_run(const GridRequest& asked, const EngineTable& engines);
// The same of one case and these runs, without a search for stable steps. `asked` says the rest.
GridRun plan_runs_of(const Case& definition, const std::vector<RunName>& runs, const GridRequest& asked,
                     const EngineTable& engines);
OutputFolder output_folder_of(const GridRequest& asked);
GridOptions options_of(const GridRun& run, const OutputFolder& folder);
std::vector<std::string> report_files();
// Runs the grid and shows its progress.
void run_with_progress(Results& grid, const EngineTable& engines, GridOptions options, const GridRequest& asked);

void judge(GridRun& run);
// The title of one part (--shard) of a grid. `deviations` is empty for a sweep.
PartTitle title_of_part(const Invocation& invocation, const Shard& shard, const std::string& suite,
                        const std::string& deviations, std::vector<std::pair<std::string, std::string>> plans,
                        double wall_seconds);

// What a command adds to the reports.
struct ReportAdditions {
  std::vector<std::pair<std::string, std::string>> files = {};  // names and texts
  std::function<std::string(const std::string&)> on_page = {};  // changes report.html
  bool can_resume = true;                                       // the command has --resume
};

// Puts every output that could be written into place and reports the others. Returns whether all could be written.
bool write_reports(const Results& grid, OutputFolder& folder, const ReportAdditions& added = {});

// The exit code of the grid without its gates: bad input, or a cell that broke.
int ending_of(const Results& grid, bool is_whole);
// Prints what `run` or `gate` prints and returns its exit code. `is_whole`: all outputs were written.
int answer(const GridRun& run, bool is_whole);

}  // namespace rigor::inline cli
