// rigor merge: joins the parts that --shard made, judges them and writes the reports of one run or sweep.
#include <fmt/format.h>

#include <filesystem>

#include "cases/case/suite.h"
#include "cases/cli/grid_run.h"
#include "cases/cli/output.h"
#include "cases/cli/sweep_merge.h"
#include "cases/report/json/machine.h"
#include "cases/runner/build_identity.h"
#include "cases/runner/shards/part.h"
#include "core/base/error.h"

namespace rigor {
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

// The command line that made the parts, with the folders of this one.
CommandLine line_of_parts(const CommandLine& line, const PartTitle& title) {
  std::vector<const char*> words = {"rigor"};
  for (const std::string& word : title.arguments) words.push_back(word.c_str());
  CommandLine made_by = parse_command_line(static_cast<int>(words.size()), words.data());
  made_by.out = line.out;
  made_by.suite_dir = folder_of(line.suite_dir, default_suite_dir(), title.suite);
  made_by.adapters_dir = folder_of(line.adapters_dir, default_adapters_dir(), title.adapters);
  return made_by;
}

void check_same_plan(const GridRun& run, const PartTitle& title, const EngineTable& engines,
                     const GridOptions& options) {
  const auto plans = plans_of(run.grid, engines, options);
  if (plans == title.plans) return;
  for (std::size_t i = 0; i < std::min(plans.size(), title.plans.size()); ++i) {
    if (plans[i] != title.plans[i])
      throw InputError(
          fmt::format("the case '{}' in '{}' is not what the parts were made of; merge with the cases of "
                      "then, see --suite",
                      plans[i].first, run.line.suite_dir));
  }
  throw InputError(
      fmt::format("there are {} cases in '{}', and the parts were made of {}; merge with the cases of "
                  "then, see --suite",
                  plans.size(), run.line.suite_dir, title.plans.size()));
}

// The files themselves where the file system allows it.
void gather_trajectories(const Merged& merged, const OutputFolder& folder) {
  for (const auto& [name, part] : merged.trajectories) {
    const fs::path from = fs::path(part) / "trajectories" / name, to = fs::path(folder.trajectories()) / name;
    std::error_code not_linked, not_copied;
    fs::create_hard_link(from, to, not_linked);
    if (not_linked) fs::copy_file(from, to, fs::copy_options::overwrite_existing, not_copied);
    if (not_copied)
      throw InputError(fmt::format("{}: is no whole part: its trajectory '{}' cannot be read: {}", part, name,
                                   not_copied.message()));
  }
}

}  // namespace

static int merge_command(const CommandLine& line, const EngineTable& engines) {
  if (line.words.empty())
    throw InputError("rigor merge: takes the folders of all parts, as 'rigor run --shard K/N --out DIR' wrote them");
  std::vector<Part> parts;
  for (const std::string& word : line.words) parts.push_back(read_part(word));
  check_same_grid(parts);
  check_same_program(parts.front());
  const CommandLine made_by = line_of_parts(line, parts.front().title);
  if (made_by.command == "sweep") return merge_sweep(made_by, parts, engines);
  GridRun run = plan_run(made_by, engines);
  OutputFolder folder = output_folder_of(line);
  check_same_plan(run, parts.front().title, engines, options_of(run, folder));
  const Merged merged = fill_in(run.grid, parts);
  gather_trajectories(merged, folder);
  judge(run);
  const bool is_whole = write_reports(run.grid, folder);
  const int ending = answer(run, is_whole);
  for (const std::string& remark : merged.remarks) say(remark);
  for (const std::string& missing : merged.missing) say(missing + "; this is not the whole grid");
  return merged.missing.empty() ? ending : int{kBroken};
}

CommandRow merge_row() {
  return {"merge",
          "merge the results of --shard runs into one result",
          "DIR",
          "the output folders of all parts",
          {"--deviations", "--out", "--plugin", "--suite"},
          {{"rigor merge part1 part2 part3 --out whole", "three parts, made by --shard 1/3, 2/3 and 3/3"},
           {"rigor merge parts/* --out whole", "all folders in parts"}},
          merge_command};
}

}  // namespace rigor
