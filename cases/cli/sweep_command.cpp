// rigor sweep: runs a grid, or a sample of one, over steps, options and values of the scene. Writes a table and a page.
// Also runs one shard of a sweep, and merges all shards.
#include <fmt/format.h>

#include <fstream>
#include <map>

#include "cases/analysis/sweep/sweep.h"
#include "cases/cli/chosen_cases.h"
#include "cases/cli/grid_run.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/progress.h"
#include "cases/cli/vocabulary.h"
#include "cases/report/csv/sweep_table.h"
#include "cases/report/html/sweep_page.h"
#include "cases/runner/shards/part.h"
#include "core/base/content_hash.h"
#include "core/base/error.h"

namespace rigor::inline cli {
namespace {

constexpr const char *kCsv = "sweep.csv", *kJsonLines = "sweep.jsonl", *kPage = "sweep.html";

struct SweepRequest {
  Invocation invocation;
  CaseWords cases;
  EngineOptions engines;
  StepOption steps;
  DurationOption duration;
  JobsOption jobs;
  TimeoutOption timeout;
  OutOption out;
  ResumeOption resume;
  SeedOption seed;
  ShardOption shard;
  std::vector<std::string> vary, metrics;  // KEY=VALUES; the metrics asked for
  std::size_t samples = 0;                 // 0: the full grid

  void declare(Options& options) {
    cases.declare(options), engines.declare(options), steps.declare(options), duration.declare(options);
    jobs.declare(options), timeout.declare(options), out.declare(options), resume.declare(options);
    seed.declare(options), shard.declare(options);
    options.add({"--vary", "KEY=VALUES",
                 "dt, duration, a method's option or a path below scene, and its values: 10,20,50 or 0.1..0.9:9 or "
                 "1/1000..1/10:log:20"},
                vary);
    options.add({"--metric", "M", "measure this in place of the usual metrics"}, metrics);
    options.add({"--sample", "N", "draw N points of the space in place of its full grid"},
                [this](const std::string& text) {
                  samples = static_cast<std::size_t>(parse_count(text, "--sample", 1000000));
                });
  }
};

SweepInput input_of(const SweepRequest& asked, const Vocabulary& words) {
  if (asked.cases.words.empty()) throw InputError("rigor sweep: takes at least one case; see rigor list cases");
  if (asked.vary.empty())
    throw InputError(
        "rigor sweep: takes at least one --vary KEY=VALUES, as dt=1/1000..1/10:log:20, iterations=10,20,50 "
        "or scene.spring[0].stiffness=1e2..1e6:log:25");
  SweepInput input;
  input.cases = overridden_cases(asked.cases, asked.invocation, {asked.steps.dt, asked.duration.seconds}, words);
  input.runs = runs_asked_for(asked.engines, words.engines);
  for (const std::string& text : asked.vary) input.axes.push_back(parse_axis(text, asked.samples > 0));
  input.metrics = asked.metrics, input.samples = asked.samples, input.seed = asked.seed.seed;
  for (const SweepAxis& axis : input.axes) {
    const bool is_set =
        (axis.key == "dt" && !asked.steps.dt.empty()) || (axis.key == "duration" && asked.duration.seconds);
    if (is_set) throw InputError(fmt::format("--{0} and --vary {0} both say what {0} is; give one of them", axis.key));
  }
  return input;
}

bool is_broken(const SweepRow& row) { return row.status == Status::crashed || row.status == Status::timed_out; }

// The tables in the folder, which grow with each row.
class SweepFiles {
 public:
  SweepFiles(const Sweep& sweep, const OutputFolder& folder)
      : sweep_(sweep),
        page_(sweep),
        csv_(folder.growing(kCsv), std::ios::binary),
        lines_(folder.growing(kJsonLines), std::ios::binary) {
    csv_ << sweep_csv_header(sweep);
  }
  void add(const SweepRow& row) {
    csv_ << sweep_csv_row(sweep_, row), lines_ << sweep_json_row(sweep_, row);
    page_.add(row);
    const bool has_run = row.status == Status::pass;
    Count& count = counts_[{row.of_case, row.run}][has_run ? row.verdict : word_of(row.status)];
    if (++count.cells == 1 && !has_run && row.status != Status::diverged) count.why = row.reason;
    has_broken_ |= is_broken(row);
  }
  void finish(OutputFolder& folder) {
    csv_.close(), lines_.close();
    if (!csv_ || !lines_) throw std::runtime_error("the table could not be written");
    folder.write(kPage, page_.text());
    folder.publish_files();
  }
  bool has_broken() const { return has_broken_; }

  std::string summary() const {
    std::string text;
    for (const auto& [of, counts] : counts_) {
      text += fmt::format("{}  {}:", sweep_.cases()[of.first].id, sweep_.runs()[of.second].text);
      for (const auto& [word, count] : counts)
        text += fmt::format(" {} {}", count.cells, word) + (word == counts.rbegin()->first ? "" : ",");
      text += "\n";
      for (const auto& [word, count] : counts) {
        if (!count.why.empty())
          text += fmt::format("  {}{}: {}\n", word, count.cells > 1 ? ", the first" : "", count.why);
      }
    }
    return text;
  }

 private:
  struct Count {
    std::size_t cells = 0;
    std::string why;  // of the first, where it came to no result
  };
  const Sweep& sweep_;
  SweepPage page_;
  std::ofstream csv_, lines_;
  std::map<std::pair<std::size_t, std::size_t>, std::map<std::string, Count>> counts_;  // by case and run; by word
  bool has_broken_ = false;
};

OutputFolder folder_of(const SweepRequest& asked) {
  const std::vector<std::string> files = {kCsv, kJsonLines, kPage, kPartFile};
  return asked.invocation.leads() ? OutputFolder(asked.out.dir, files, asked.resume.is_on)
                                  : OutputFolder::of_helper(asked.out.dir);
}

SweepOptions options_of(const SweepRequest& asked, const OutputFolder& folder) {
  return {asked.jobs.count, asked.timeout.seconds, folder.journals() + "/sweep.journal", asked.invocation.executor,
          asked.shard.shard};
}

std::string hash_of_plan(const Sweep& sweep) { return fmt::format("{:016x}", content_hash(sweep.plan())); }

int end_of(const SweepFiles& files, const Sweep& sweep, const SweepRequest& asked) {
  print_table(files.summary() + fmt::format("{} cells: {}, {} and {} are in {}\n", sweep.cells(), kCsv, kJsonLines,
                                            kPage, asked.out.dir));
  return files.has_broken() ? kBroken : kGood;
}

void say_plan(const SweepRequest& asked, std::size_t cells) {
  if (asked.invocation.leads())
    say(fmt::format("{} cells with {} jobs; the tables will be in {}", cells, asked.jobs.count, asked.out.dir));
}

int sweep_whole(const SweepRequest& asked, const Sweep& sweep, const EngineTable& engines) {
  OutputFolder folder = folder_of(asked);
  if (!asked.invocation.leads()) run_sweep(sweep, engines, options_of(asked, folder), {});
  SweepFiles files(sweep, folder);
  say_plan(asked, sweep.cells());
  try {
    Progress progress;
    std::size_t done = 0;
    run_sweep(sweep, engines, options_of(asked, folder), [&](const SweepRow& row) {
      files.add(row);
      progress.show(++done, sweep.cells());
    });
    files.finish(folder);
  } catch (...) {  // Interrupted, too
    folder.keep();
    throw;
  }
  return end_of(files, sweep, asked);
}

int sweep_shard(const SweepRequest& asked, const Sweep& sweep, const EngineTable& engines) {
  OutputFolder folder = folder_of(asked);
  const auto [begin, end] = jobs_of(sweep, asked.shard.shard);
  const std::size_t first = sweep.first_row_of(begin), rows = sweep.first_row_of(end) - first;
  bool has_broken = false;
  say_plan(asked, rows);
  try {
    Progress progress;
    std::size_t done = 0;
    std::ofstream part;
    if (asked.invocation.leads()) part.open(folder.growing(kPartFile), std::ios::binary);
    part << part_head(title_of_part(asked.invocation, asked.shard.shard, asked.cases.suite.dir, "",
                                    {{"the sweep", hash_of_plan(sweep)}}, 0),
                      rows);
    run_sweep(sweep, engines, options_of(asked, folder), [&](const SweepRow& row) {
      part << framed(first + done, {answer_of(row), ""});
      has_broken |= is_broken(row);
      progress.show(++done, rows);
    });
    part.close();
    if (!part) throw std::runtime_error("the part could not be written");
    folder.publish_files();
  } catch (...) {
    folder.keep();
    throw;
  }
  print_table(
      fmt::format("shard {0} of {1}: {2} of {3} cells\nThis is one part of {1}. 'rigor merge DIR... --out DIR' makes "
                  "the result from all parts.\n",
                  asked.shard.shard.index, asked.shard.shard.count, rows, sweep.cells()));
  return has_broken ? kBroken : kGood;
}

void apply(const Part& part, const Part::Answer& answer, std::size_t cells,
           std::map<std::size_t, std::string>& answers) {
  if (answer.of >= cells)
    throw InputError(fmt::format("{}: is damaged: it has an answer of a cell that is not in the sweep", part.folder));
  answers[answer.of] = answer.record.message;
}

SweepRow heard_of(SweepRow row, const std::map<std::size_t, std::string>& answers, std::size_t number) {
  const auto found = answers.find(number);
  if (found == answers.end()) return row.reason = "it did not run: its shard is missing", row;
  try {
    apply_answer(row, found->second);
  } catch (const std::exception& error) {
    throw InputError(
        fmt::format("a part is damaged: the answer of cell {} cannot be read: {}", number + 1, error.what()));
  }
  return row;
}

int merge_sweep(const SweepRequest& asked, const std::vector<Part>& parts, const EngineTable& engines) {
  const Vocabulary words = vocabulary_of(engines.infos());
  const Sweep sweep(input_of(asked, words), words);
  if (parts.front().title.plans.front().second != hash_of_plan(sweep))
    throw InputError("the cases are not what the parts were made of; merge with the cases of then, see --suite");
  std::map<std::size_t, std::string> answers;
  for (const Part& part : parts) {
    for (const Part::Answer& answer : part.answers) apply(part, answer, sweep.cells(), answers);
  }
  OutputFolder folder = folder_of(asked);
  SweepFiles files(sweep, folder);
  std::size_t number = 0;
  for (std::size_t job = 0; job < sweep.jobs(); ++job) {
    for (const SweepRow& row : sweep.rows_of(job)) files.add(heard_of(row, answers, number++));
  }
  files.finish(folder);
  const int ending = end_of(files, sweep, asked);
  for (const std::string& missing : missing_shards(parts)) say(missing + "; this is not the whole sweep");
  return answers.size() == sweep.cells() ? ending : int{kBroken};
}

class SweepCommand : public SharedCommand {
 public:
  void declare(Options& options) override { asked_.declare(options); }

  int run(const Invocation& invocation) override {
    asked_.invocation = invocation;
    const EngineTable engines = asked_.engines.outside.table(asked_.timeout.seconds);
    const Vocabulary words = vocabulary_of(engines.infos());
    const Sweep sweep(input_of(asked_, words), words);
    return asked_.shard.shard.is_all() ? sweep_whole(asked_, sweep, engines) : sweep_shard(asked_, sweep, engines);
  }

  int merge(const Invocation& invocation, const MergeFolders& folders, const std::vector<Part>& parts,
            const EngineTable& engines) override {
    asked_.invocation = invocation;
    asked_.out.dir = folders.out, asked_.cases.suite.dir = folders.suite;
    return merge_sweep(asked_, parts, engines);
  }

 private:
  SweepRequest asked_;
};

}  // namespace

CommandRow sweep_row() {
  return {"sweep",
          "run cases over steps, options and values of the scene; write a table and maps",
          "CASE",
          kCases,
          {{"rigor sweep springs/stiff-1 --vary dt=1/1000..1/10:log:20 --engine ode", "twenty step sizes"},
           {"rigor sweep springs/stiff-1 --vary dt=1/100,1/200 --vary duration=1,2 --engine core:rk4",
            "a grid of two axes"}},
          make_command<SweepCommand>};
}

}  // namespace rigor::inline cli
