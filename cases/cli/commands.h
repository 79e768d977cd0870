// The table of commands. `rigor --help`, completions, the manual and near matches are made from it.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/mistakes/finder.h"
#include "cases/case/case.h"
#include "cases/cli/shared_options.h"
#include "cases/runner/executor.h"

namespace rigor::inline runner {
struct Part;
}

namespace rigor::inline cli {

enum ExitCode { kGood = 0, kGateFailed = 1, kBadInput = 2, kBroken = 3 };

// The call of a command, as far as no option says it.
struct Invocation {
  std::string command;                 // "run"
  std::vector<std::string> arguments;  // as typed, without those in which the parts of one grid may differ
  const Executor* executor = nullptr;  // of a grid's cases and a sweep's; null: processes of this machine
  // Whether this process plans, judges and writes. Otherwise it works for one that does.
  bool leads() const { return executor == nullptr || executor->leads(); }
};

class SharedCommand;

// A command with its own options. Each command line makes a new one.
class Command {
 public:
  virtual ~Command() = default;
  virtual void declare(Options& options) = 0;
  virtual int run(const Invocation& invocation) = 0;  // returns an ExitCode
  virtual SharedCommand* shared() { return nullptr; }
};

// The folders of `rigor merge`. The others are those that the parts were made with.
struct MergeFolders {
  std::string out, suite, deviations;
};

// A command with --shard: several processes may share it, and `rigor merge` joins its parts.
class SharedCommand : public Command {
 public:
  virtual int merge(const Invocation& invocation, const MergeFolders& folders, const std::vector<Part>& parts,
                    const EngineTable& engines) = 0;
  SharedCommand* shared() override { return this; }
};

struct Example {
  std::string call, does;
};

struct CommandRow {
  std::string name;
  std::string summary;
  std::string words;  // the name of its plain words, as "CASE"; "" if it takes none
  std::string words_summary;
  std::vector<Example> examples;
  std::unique_ptr<Command> (*make)();
  std::vector<std::string> known_words = {};  // for completions; cases are known without
};

template <typename C>
std::unique_ptr<Command> make_command() {
  return std::make_unique<C>();
}

// The options of a command in alphabetical order, without --help.
std::vector<OptionFact> options_of(const CommandRow& row);
bool has_option(const CommandRow& row, const std::string& name);

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
RunName run_asked_for(const EngineOptions& options, const std::string& command, const EngineTable& engines);

// Finds the mistake that explains the run's error on these scenes.
MistakeReport diagnosed(const EngineTable& engines, const RunName& run, std::vector<ProbeScene> probes, int jobs,
                        double limit);

// Returns the one case that the words of a command name. Throws InputError.
Case the_case(const CaseWords& cases, const Invocation& invocation, const EngineTable& engines);

}  // namespace rigor::inline cli
