// The table of commands. `rigor --help`, completions and near matches are made from it.
#pragma once

#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/mistakes/finder.h"
#include "cases/cli/command_line.h"

namespace rigor {

enum ExitCode { kGood = 0, kGateFailed = 1, kBadInput = 2, kBroken = 3 };

struct Example {
  std::string call, does;
};

struct CommandRow {
  std::string name;
  std::string summary;
  std::string words;  // the name of its plain words, as "CASE"; "" if it takes none
  std::string words_summary;
  std::vector<std::string> options;
  std::vector<Example> examples;
  int (*run)(const CommandLine& line, const EngineTable& engines);  // returns an ExitCode
};

const std::vector<CommandRow>& commands();  // in the order of the README

int list_command(const CommandLine& line, const EngineTable& engines);
int run_command(const CommandLine& line, const EngineTable& engines);
int gate_command(const CommandLine& line, const EngineTable& engines);
int sweep_command(const CommandLine& line, const EngineTable& engines);
int tune_command(const CommandLine& line, const EngineTable& engines);
int history_command(const CommandLine& line, const EngineTable& engines);
int merge_command(const CommandLine& line, const EngineTable& engines);
int compare_command(const CommandLine& line, const EngineTable& engines);
int baseline_command(const CommandLine& line, const EngineTable& engines);
int trace_command(const CommandLine& line, const EngineTable& engines);
int truth_command(const CommandLine& line, const EngineTable& engines);
int new_command(const CommandLine& line, const EngineTable& engines);
int completion_command(const CommandLine& line, const EngineTable& engines);
int import_command(const CommandLine& line, const EngineTable& engines);
int export_command(const CommandLine& line, const EngineTable& engines);
int open_command(const CommandLine& line, const EngineTable& engines);
int settle_command(const CommandLine& line, const EngineTable& engines);
int conform_command(const CommandLine& line, const EngineTable& engines);
int diagnose_command(const CommandLine& line, const EngineTable& engines);

// Returns the run that --engine names, else the only engine of --plugin or from outside. Throws InputError.
RunName run_asked_for(const CommandLine& line, const EngineTable& engines);

// Finds the mistake that explains the run's error, on the named cases or else on Rigor's own choice.
MistakeReport diagnosed(const CommandLine& line, const EngineTable& engines, const RunName& run);

// Returns the one case that the words of a command name. Throws InputError.
Case the_case(const CommandLine& line, const EngineTable& engines);

}  // namespace rigor
