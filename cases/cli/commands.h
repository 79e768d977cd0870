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

// Facts about all commands, for the manual page and the reference.
struct NamedFact {
  std::string name, meaning;
};
const std::vector<NamedFact>& exit_codes();
const std::vector<NamedFact>& environment_variables();

const std::vector<CommandRow>& commands();  // in the order of the README

// The words that many commands take.
inline constexpr const char *kCases = "case ids, families, files or folders",
                            *kCasesOrAll = "case ids, families, files or folders; default: the whole suite";

// Reads a value of --engine. Throws InputError.
RunName run_of_option(const std::string& value, const std::vector<EngineInfo>& infos);

// Returns the run that --engine names, else the only engine of --plugin or from outside. Throws InputError.
RunName run_asked_for(const CommandLine& line, const EngineTable& engines);

// Finds the mistake that explains the run's error, on the named cases or else on Rigor's own choice.
MistakeReport diagnosed(const CommandLine& line, const EngineTable& engines, const RunName& run);

// Returns the one case that the words of a command name. Throws InputError.
Case the_case(const CommandLine& line, const EngineTable& engines);

}  // namespace rigor
