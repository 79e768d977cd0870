// rigor sweep: runs a grid, or a sample of one, over steps, options and values of the scene. Writes a table and a page.
// Also runs one shard of a sweep, and merges all shards.
#include <fmt/format.h>

#include <fstream>
#include <map>

#include "cases/analysis/sweep/sweep.h"
#include "cases/cli/chosen_cases.h"
#include "cases/cli/grid_run.h"
#include "cases/cli/options.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/progress.h"
#include "cases/cli/sweep_merge.h"
#include "cases/cli/vocabulary.h"
#include "cases/report/csv/sweep_table.h"
#include "cases/report/html/sweep_page.h"
#include "cases/runner/shards/part.h"
#include "core/base/content_hash.h"
#include "core/base/error.h"

namespace rigor {
namespace {

constexpr const char *kCsv = "sweep.csv", *kJsonLines = "sweep.jsonl", *kPage = "sweep.html";

SweepInput input_of(const CommandLine& line, const Vocabulary& words) {
  if (line.words.empty()) throw InputError("rigor sweep: takes at least one case; see rigor list cases");
  if (line.vary.empty())
    throw InputError(
        "rigor sweep: takes at least one --vary KEY=VALUES, as dt=1/1000..1/10:log:20, iterations=10,20,50 "
        "or scene.spring[0].stiffness=1e2..1e6:log:25");
  SweepInput input;
  input.cases = overridden_cases(line, words);
  input.runs = runs_asked_for(line, words.engines);
  for (const std::string& text : line.vary) input.axes.push_back(parse_axis(text, line.samples > 0));
  input.metrics = line.metrics, input.samples = line.samples, input.seed = line.seed;
  for (const SweepAxis& axis : input.axes) {
    const bool is_set = (axis.key == "dt" && !line.dt.empty()) || (axis.key == "duration" && line.duration);
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

OutputFolder folder_of(const CommandLine& line) {
  const std::vector<std::string> files = {kCsv, kJsonLines, kPage, kPartFile};
  return leads(line) ? OutputFolder(line.out, files, line.resume) : OutputFolder::of_helper(line.out);
}

SweepOptions options_of(const CommandLine& line, const OutputFolder& folder) {
  return {line.jobs, line.limit, folder.journals() + "/sweep.journal", line.executor, line.shard};
}

std::string hash_of_plan(const Sweep& sweep) { return fmt::format("{:016x}", content_hash(sweep.plan())); }

int end_of(const SweepFiles& files, const Sweep& sweep, const CommandLine& line) {
  print_table(files.summary() +
              fmt::format("{} cells: {}, {} and {} are in {}\n", sweep.cells(), kCsv, kJsonLines, kPage, line.out));
  return files.has_broken() ? kBroken : kGood;
}

void say_plan(const CommandLine& line, std::size_t cells) {
  if (leads(line)) say(fmt::format("{} cells with {} jobs; the tables will be in {}", cells, line.jobs, line.out));
}

int sweep_whole(const CommandLine& line, const Sweep& sweep, const EngineTable& engines) {
  OutputFolder folder = folder_of(line);
  if (!leads(line)) run_sweep(sweep, engines, options_of(line, folder), {});
  SweepFiles files(sweep, folder);
  say_plan(line, sweep.cells());
  try {
    Progress progress;
    std::size_t done = 0;
    run_sweep(sweep, engines, options_of(line, folder), [&](const SweepRow& row) {
      files.add(row);
      progress.show(++done, sweep.cells());
    });
    files.finish(folder);
  } catch (...) {  // Interrupted, too
    folder.keep();
    throw;
  }
  return end_of(files, sweep, line);
}

int sweep_shard(const CommandLine& line, const Sweep& sweep, const EngineTable& engines) {
  OutputFolder folder = folder_of(line);
  const auto [begin, end] = jobs_of(sweep, line.shard);
  const std::size_t first = sweep.first_row_of(begin), rows = sweep.first_row_of(end) - first;
  bool has_broken = false;
  say_plan(line, rows);
  try {
    Progress progress;
    std::size_t done = 0;
    std::ofstream part;
    if (leads(line)) part.open(folder.growing(kPartFile), std::ios::binary);
    part << part_head(title_of_part(line, {{"the sweep", hash_of_plan(sweep)}}, 0), rows);
    run_sweep(sweep, engines, options_of(line, folder), [&](const SweepRow& row) {
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
                  line.shard.index, line.shard.count, rows, sweep.cells()));
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

}  // namespace

int sweep_command(const CommandLine& line, const EngineTable& engines) {
  const Vocabulary words = vocabulary_of(engines.infos());
  const Sweep sweep(input_of(line, words), words);
  return line.shard.is_all() ? sweep_whole(line, sweep, engines) : sweep_shard(line, sweep, engines);
}

int merge_sweep(const CommandLine& line, const std::vector<Part>& parts, const EngineTable& engines) {
  const Vocabulary words = vocabulary_of(engines.infos());
  const Sweep sweep(input_of(line, words), words);
  if (parts.front().title.plans.front().second != hash_of_plan(sweep))
    throw InputError("the cases are not what the parts were made of; merge with the cases of then, see --suite");
  std::map<std::size_t, std::string> answers;
  for (const Part& part : parts) {
    for (const Part::Answer& answer : part.answers) apply(part, answer, sweep.cells(), answers);
  }
  OutputFolder folder = folder_of(line);
  SweepFiles files(sweep, folder);
  std::size_t number = 0;
  for (std::size_t job = 0; job < sweep.jobs(); ++job) {
    for (const SweepRow& row : sweep.rows_of(job)) files.add(heard_of(row, answers, number++));
  }
  files.finish(folder);
  const int ending = end_of(files, sweep, line);
  for (const std::string& missing : missing_shards(parts)) say(missing + "; this is not the whole sweep");
  return answers.size() == sweep.cells() ? ending : int{kBroken};
}

CommandRow sweep_row() {
  return {"sweep",
          "run cases over steps, options and values of the scene; write a table and maps",
          "CASE",
          kCases,
          with_import_options({"--dt", "--duration", "--engine", "--jobs", "--metric", "--out", "--plugin", "--resume",
                               "--sample", "--seed", "--shard", "--suite", "--timeout", "--vary"}),
          {{"rigor sweep springs/stiff-1 --vary dt=1/1000..1/10:log:20 --engine ode", "twenty step sizes"},
           {"rigor sweep springs/stiff-1 --vary dt=1/100,1/200 --vary duration=1,2 --engine core:rk4",
            "a grid of two axes"}},
          sweep_command};
}

}  // namespace rigor
