// The values of a command line. Each command checks its own words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "cases/case/case.h"
#include "cases/import/import_options.h"
#include "cases/runner/executor.h"
#include "cases/runner/shards/shard.h"

namespace rigor {

struct CommandLine {
  std::string command;             // "list", "run", ...
  std::vector<std::string> words;  // cases; for `list`, what to list
  std::vector<std::string> engines;
  std::vector<StepSize> dt;
  std::optional<double> duration;  // s
  std::vector<double> times;       // s; for `truth`
  int jobs = 1;
  int every = 1;
  double limit = 120;  // s
  double factor = 0;   // by which an error has to grow to be worse
  std::string out = "out";
  std::string suite_dir;
  std::string adapters_dir;          // of the known deviations
  std::vector<std::string> plugins;  // engines from outside: paths of shared libraries, and command lines
  std::string regression;            // the engine whose recorded values `baseline` prints; empty: the baseline itself
  bool quick = false, resume = false, json = false, verbose = false;
  bool contacts = false;                   // of trace
  Shard shard;                             // of run, gate and sweep: all, or a part for `rigor merge`
  std::vector<std::string> vary, metrics;  // of a sweep: KEY=VALUES; the metrics asked for
  std::size_t samples = 0;                 // of a sweep; 0: the full grid
  unsigned long seed = 1;
  std::vector<std::string> within;     // of tune: bounds, "1mm"
  std::string file = "history.jsonl";  // of history
  std::string page;                    // of history: where it is drawn; empty: nowhere
  ImportOptions import;                // of robots' files
  std::string format;                  // of trace and export; empty: the default
  std::vector<std::string> arguments;  // as typed, without where to, how many at once, and which shard
  const Executor* executor = nullptr;  // of a grid's cases and a sweep's; null: processes of this machine
  std::string printed;                 // --help or --version: what to print instead of doing anything
};

// Whether this process plans, judges and writes. Otherwise it works for one that does.
inline bool leads(const CommandLine& line) { return line.executor == nullptr || line.executor->leads(); }

// Throws InputError with the nearest match of an unknown word. `jobs` is the default of --jobs; 0 means one a core.
CommandLine parse_command_line(int argc, const char* const* argv, int jobs = 0);

}  // namespace rigor
