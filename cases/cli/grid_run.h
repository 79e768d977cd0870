// What run, gate and merge have in common: the grid that a command line asks for, and what is made of it once it has
// run.
#pragma once

#include <string>
#include <vector>

#include "cases/cli/commands.h"
#include "cases/gates/deviations.h"
#include "cases/gates/gates.h"
#include "cases/runner/grid.h"
#include "cases/runner/output_folder.h"
#include "cases/runner/shards/part.h"

namespace rigor {

struct GridRun {
  const CommandLine& line;
  const EngineTable& engines;
  std::vector<KnownDeviation> deviations;
  RecordedValues recorded;
  Results grid;
};

// The engines of this program that a run leaves out for it names none: those that take part on request. Empty: none.
std::string left_out_by_default(const CommandLine& line, const std::vector<EngineInfo>& infos);

// The runs that --engine names, each once; without any, the default runs.
std::vector<RunName> runs_asked_for(const CommandLine& line, const std::vector<EngineInfo>& infos);

// Nothing has run yet. Throws InputError.
GridRun plan_run(const CommandLine& line, const EngineTable& engines);
OutputFolder output_folder_of(const CommandLine& line);
GridOptions options_of(const GridRun& run, const OutputFolder& folder);
std::vector<std::string> report_files();

void judge(GridRun& run);
// Of a part of what the line asks for.
PartTitle title_of_part(const CommandLine& line, std::vector<std::pair<std::string, std::string>> plans,
                        double wall_seconds);

// Puts every output that could be written into place and says what could not. Returns whether all could.
bool write_reports(const Results& grid, OutputFolder& folder);

// What of the grid itself, gates aside, the exit code is made of: bad input, and what broke.
int ending_of(const Results& grid, bool is_whole);
// Prints what `run` or `gate` prints and returns its exit code. `is_whole`: all outputs were written.
int answer(const GridRun& run, bool is_whole);

}  // namespace rigor
