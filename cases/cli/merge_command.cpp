// rigor merge: joins the parts that --shard made, judges them and writes the reports of one run or sweep.
#include <fmt/format.h>

#include <filesystem>

#include "cases/case/suite.h"
#include "cases/cli/command_line.h"
#include "cases/cli/output.h"
#include "cases/gates/deviations.h"
#include "cases/report/json/machine.h"
#include "cases/runner/build_identity.h"
#include "cases/runner/shards/part.h"
#include "core/base/error.h"

namespace rigor::inline cli {
namespace {

namespace fs = std::filesystem;

void check_same_program(const Part& part) {
  const std::string version = this_machine().program_version;
  if (part.title.version != version)
    throw InputError(fmt::format("{}: was made by version {}, and this is {}; merge with the version that made it",
                                 part.folder, part.title.version, version));
  if (part.title.build != build_identity())
    throw InputError(
        fmt::format("{}: was made by another build of rigor, or with another build of an engine's "
                    "library; merge with the build that made it",
                    part.folder));
}

std::string folder_of(const std::string& asked_for, const std::string& by_default, const std::string& of_part) {
  std::error_code error;
  return asked_for == by_default && fs::is_directory(of_part, error) ? of_part : asked_for;
}

// The command line that made the parts.
CommandLine line_of_parts(const PartTitle& title) {
  std::vector<const char*> words = {"rigor"};
  for (const std::string& word : title.arguments) words.push_back(word.c_str());
  return parse_command_line(static_cast<int>(words.size()), words.data());
}

class MergeCommand : public Command {
 public:
  void declare(Options& options) override {
    options.add_words(folders_);
    deviations_.declare(options), out_.declare(options), outside_.declare(options), suite_.declare(options);
  }

  int run(const Invocation&) override {
    if (folders_.empty())
      throw InputError("rigor merge: takes the folders of all parts, as 'rigor run --shard K/N --out DIR' wrote them");
    std::vector<Part> parts;
    for (const std::string& folder : folders_) parts.push_back(read_part(folder));
    check_same_grid(parts);
    check_same_program(parts.front());
    const PartTitle& title = parts.front().title;
    const CommandLine made_by = line_of_parts(title);
    SharedCommand* command = made_by.command ? made_by.command->shared() : nullptr;
    if (!command) throw InputError(fmt::format("{}: is damaged: no command with parts made it", parts.front().folder));
    const MergeFolders folders{out_.dir, folder_of(suite_.dir, default_suite_dir(), title.suite),
                               folder_of(deviations_.dir, default_adapters_dir(), title.adapters)};
    return command->merge(made_by.invocation, folders, parts, outside_.table(TimeoutOption().seconds));
  }

 private:
  std::vector<std::string> folders_;
  DeviationsOption deviations_;
  OutOption out_;
  PluginOption outside_;
  SuiteOption suite_;
};

}  // namespace

CommandRow merge_row() {
  return {"merge",
          "merge the results of --shard runs into one result",
          "DIR",
          "the output folders of all parts",
          {{"rigor merge part1 part2 part3 --out whole", "three parts, made by --shard 1/3, 2/3 and 3/3"},
           {"rigor merge parts/* --out whole", "all folders in parts"}},
          make_command<MergeCommand>};
}

}  // namespace rigor::inline cli
