// rigor run and rigor gate: run a grid, write its reports and return its exit code. Or run one shard, or merge all
// shards, for `rigor merge`.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "cases/cli/grid_run.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/plan_sentence.h"
#include "cases/runner/shards/part.h"
#include "core/base/error.h"

namespace rigor::inline cli {
namespace {

namespace fs = std::filesystem;

int run_whole(const GridRequest& asked, const EngineTable& engines) {
  GridRun run = plan_run(asked, engines);
  OutputFolder folder = output_folder_of(asked);
  if (asked.invocation.leads()) say(plan_sentence(run.grid, asked));
  bool is_whole = false;
  try {
    run_with_progress(run.grid, engines, options_of(run, folder), asked);
    judge(run);
    is_whole = write_reports(run.grid, folder);
  } catch (...) {  // Interrupted, too
    folder.keep();
    throw;
  }
  return answer(run, is_whole);
}

// The number of cells of this shard, and their results.
std::string summary_of(const GridRequest& asked, const Results& share) {
  std::map<std::string, int> counts;
  int all = 0;
  for (const CaseResult& result : share.cases) {
    for (const Cell& cell : result.cells) {
      if (cell.status != Status::unsupported) ++counts[word_of(cell.status)], ++all;
    }
  }
  std::string text = fmt::format("shard {} of {}: {} cells", asked.shard.shard.index, asked.shard.shard.count, all);
  // Gates are judged with all parts. Before that a cell that passes has only run.
  for (const auto& [word, count] : counts) text += fmt::format(", {} {}", count, word == "pass" ? "ran" : word);
  return text +
         fmt::format("\nThis is one part of the result. To join and judge all {} parts: rigor merge DIR... --out DIR\n",
                     asked.shard.shard.count);
}

int run_shard(const GridRequest& asked, const EngineTable& engines) {
  GridRun run = plan_run(asked, engines);
  OutputFolder folder = output_folder_of(asked);
  const GridOptions options = options_of(run, folder);
  const Results planned = share_of(run.grid, asked.shard.shard);
  if (asked.invocation.leads()) say(plan_sentence(planned, asked));
  Results share = planned;
  try {
    run_with_progress(share, engines, options, asked);
    const PartTitle title =
        title_of_part(asked.invocation, asked.shard.shard, asked.cases.suite.dir, asked.deviations.dir,
                      plans_of(run.grid, engines, options), share.wall_seconds);
    folder.write(kPartFile, part_text(title, planned, share, engines, options));
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
  print_table(summary_of(asked, share));
  return ending_of(share, true);
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
                      plans[i].first, run.asked.cases.suite.dir));
  }
  throw InputError(
      fmt::format("there are {} cases in '{}', and the parts were made of {}; merge with the cases of "
                  "then, see --suite",
                  plans.size(), run.asked.cases.suite.dir, title.plans.size()));
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

int merge_grid(const GridRequest& asked, const std::vector<Part>& parts, const EngineTable& engines) {
  GridRun run = plan_run(asked, engines);
  OutputFolder folder = output_folder_of(asked);
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

// `run` judges, and returns 0 whatever the gates say. `gate` returns 1 if one does not hold.
class GridCommand : public SharedCommand {
 public:
  explicit GridCommand(bool is_gate) { asked_.is_gate = is_gate; }

  void declare(Options& options) override { asked_.declare(options); }

  int run(const Invocation& invocation) override {
    asked_.invocation = invocation;
    if (asked_.has_series && !asked_.shard.shard.is_all())
      throw InputError(fmt::format("rigor {}: a part has no --series; run without --shard", invocation.command));
    const EngineTable engines = asked_.engines.outside.table(asked_.timeout.seconds);
    return asked_.shard.shard.is_all() ? run_whole(asked_, engines) : run_shard(asked_, engines);
  }

  int merge(const Invocation& invocation, const MergeFolders& folders, const std::vector<Part>& parts,
            const EngineTable& engines) override {
    asked_.invocation = invocation;
    asked_.out.dir = folders.out, asked_.cases.suite.dir = folders.suite, asked_.deviations.dir = folders.deviations;
    return merge_grid(asked_, parts, engines);
  }

 private:
  GridRequest asked_;
};

std::unique_ptr<Command> make_run() { return std::make_unique<GridCommand>(false); }
std::unique_ptr<Command> make_gate() { return std::make_unique<GridCommand>(true); }

}  // namespace

CommandRow run_row() {
  return {
      "run",
      "simulate cases, judge the results, print a table and write reports",
      "CASE",
      kCasesOrAll,
      {{"rigor run springs/fixed-spring", "one case by every engine; the report is out/report.html"},
       {"rigor run springs --engine ode --engine core:rk4 --dt 1/60", "a family of cases, two engines, one step size"},
       {"rigor run robot.urdf my-case.toml --out robots", "files of your own"}},
      make_run};
}

CommandRow gate_row() {
  return {"gate",
          "run, and exit 1 if a gate does not hold",
          "CASE",
          kCasesOrAll,
          {{"rigor gate --quick", "for each change: the fast gates of the whole suite"},
           {"rigor gate --engine bullet", "all gates of one engine"},
           {"rigor gate springs --plugin ./my_engine.so", "an engine of your own against one family"}},
          make_gate};
}

}  // namespace rigor::inline cli
