// rigor sweep: a grid, or a sample of one, over steps, options and values of the scene; as a table and drawn.
#include <fmt/format.h>

#include <fstream>
#include <map>

#include "cases/analysis/sweep.h"
#include "cases/cli/chosen_cases.h"
#include "cases/cli/grid_run.h"
#include "cases/cli/output.h"
#include "cases/cli/progress.h"
#include "cases/cli/vocabulary.h"
#include "cases/report/csv/sweep_table.h"
#include "cases/report/html/sweep_page.h"
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
  input.cases = chosen_cases(line, words);
  for (Case& definition : input.cases) override_run(definition, {line.dt, line.duration});
  input.runs = runs_asked_for(line, words.engines);
  for (const std::string& text : line.vary) input.axes.push_back(parse_axis(text, line.samples > 0));
  input.metrics = line.metrics, input.samples = line.samples, input.seed = line.seed;
  for (const SweepAxis& axis : input.axes) {
    const bool is_set = (axis.key == "dt" && !line.dt.empty()) || (axis.key == "duration" && line.duration);
    if (is_set) throw InputError(fmt::format("--{0} and --vary {0} both say what {0} is; give one of them", axis.key));
  }
  return input;
}

// The tables grow in the folder as rows come.
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
    ++counts_[{row.of_case, row.run}][row.status == Status::pass ? row.verdict : word_of(row.status)];
    has_broken_ |= row.status == Status::crashed || row.status == Status::timed_out;
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
        text += fmt::format(" {} {}", count, word) + (word == counts.rbegin()->first ? "" : ",");
      text += "\n";
    }
    return text;
  }

 private:
  const Sweep& sweep_;
  SweepPage page_;
  std::ofstream csv_, lines_;
  std::map<std::pair<std::size_t, std::size_t>, std::map<std::string, std::size_t>> counts_;
  bool has_broken_ = false;
};

}  // namespace

int sweep_command(const CommandLine& line, const EngineTable& engines) {
  const Vocabulary words = vocabulary_of(engines.infos());
  const Sweep sweep(input_of(line, words), words);
  OutputFolder folder(line.out, {kCsv, kJsonLines, kPage}, line.resume);
  SweepFiles files(sweep, folder);
  try {
    Progress progress;
    std::size_t done = 0;
    run_sweep(sweep, engines, {line.jobs, line.limit, folder.journals() + "/sweep.journal"}, [&](const SweepRow& row) {
      files.add(row);
      progress.show(++done, sweep.cells());
    });
    files.finish(folder);
  } catch (...) {  // Interrupted, too
    folder.keep();
    throw;
  }
  print_table(files.summary() +
              fmt::format("{} cells: {}, {} and {} are in {}\n", sweep.cells(), kCsv, kJsonLines, kPage, line.out));
  return files.has_broken() ? kBroken : kGood;
}

}  // namespace rigor
