// Options that several commands share. A command composes those that it takes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/case/case.h"
#include "cases/cli/options.h"
#include "cases/import/import_options.h"
#include "cases/runner/shards/shard.h"

namespace rigor::inline cli {

struct SuiteOption {
  std::string dir;  // of the cases
  void declare(Options& options);
};

// Of robots' files.
struct ImportFlags {
  ImportOptions chosen;
  void declare(Options& options);
};

struct CaseWords {
  std::vector<std::string> words;  // case ids, families, files or folders
  SuiteOption suite;
  ImportFlags imports;
  void declare(Options& options);
};

struct PluginOption {
  std::vector<std::string> plugins;  // engines from outside: paths of shared libraries, and command lines
  void declare(Options& options);
  // The built-in engines, those that RIGOR_PLUGINS names, and these. `limit` [s] is that of a request.
  EngineTable table(double limit) const;
};

struct EngineOptions {
  std::vector<std::string> engines;
  PluginOption outside;
  void declare(Options& options);
};

struct StepOption {
  std::vector<StepSize> dt;  // empty: each case's own
  void declare(Options& options);
};

struct DurationOption {
  std::optional<double> seconds;
  void declare(Options& options);
};

struct JobsOption {
  int count = 1;
  void declare(Options& options);
};

struct TimeoutOption {
  double seconds = 120;
  void declare(Options& options);
};

struct OutOption {
  std::string dir = "out";
  void declare(Options& options);
};

struct ResumeOption {
  bool is_on = false;
  void declare(Options& options);
};

struct ShardOption {
  Shard shard;  // all, or a part for `rigor merge`
  void declare(Options& options);
};

struct DeviationsOption {
  std::string dir;  // of ENGINE/known_deviations.toml
  void declare(Options& options);
};

struct SeedOption {
  unsigned long seed = 1;
  void declare(Options& options);
};

struct JsonOption {
  bool is_on = false;
  void declare(Options& options);
};

}  // namespace rigor::inline cli
