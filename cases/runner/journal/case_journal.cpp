#include "cases/runner/journal/case_journal.h"

#include <fmt/format.h>

#include <algorithm>
#include <exception>

#include "cases/case/recording/recording_reader.h"
#include "cases/results/result_json.h"
#include "cases/runner/build_identity.h"
#include "cases/runner/shards/shard.h"

namespace rigor::inline runner {
namespace {

std::size_t index_of(const CaseResult& planned, const Results& grid) {
  return static_cast<std::size_t>(&planned - grid.cases.data());
}

// Whether a cell failed in an engine from outside. Not all of the engine's files are known, nor other causes, so a
// second try may end differently. An engine of this program would fail again.
bool may_end_otherwise(const Cell& cell, const Results& grid, const EngineTable& engines) {
  const bool came_to_nothing = cell.status == Status::crashed || cell.status == Status::timed_out;
  return came_to_nothing && !engines.identity_of(grid.runs[cell.run].engine).empty();
}

}  // namespace

std::string journal_of(const CaseResult& planned, const Results& grid, int share, const GridOptions& options) {
  if (options.journals.empty()) return "";
  const std::size_t of_case = index_of(planned, grid);
  return share == 0 ? fmt::format("{}/{}.journal", options.journals, of_case)
                    : fmt::format("{}/{}.{}.journal", options.journals, of_case, share);
}

std::string plan_of(const Results& grid, const CaseResult& planned, const EngineTable& engines,
                    const GridOptions& options) {
  const Case& definition = planned.definition;
  std::string plan = fmt::format("{}\n{}\n{}\n{:.17g} {} {} {}\n", build_identity(), definition.id, definition.text,
                                 definition.duration, options.stable_steps, options.is_thorough, grid.cases.size());
  if (const auto recording = definition.recording) plan += fmt::format("{:016x}\n", recording->content);
  for (const auto& recorder : options.recorders) plan += recorder->name() + "\n";
  for (const RunName& run : grid.runs) plan += fmt::format("{} {}\n", run.text, engines.identity_of(run.engine));
  for (const Gate& gate : definition.gates) plan += gate.metric + "\n";  // some metrics are measured for a gate alone
  for (const Cell& cell : planned.cells)
    plan += fmt::format("{} {:.17g} {} {}\n", cell.run, cell.dt.seconds, word_of(cell.status), cell.trajectory);
  for (const StableStepResult& stable : planned.stable_steps) plan += word_of(stable.status) + "\n";
  return plan;
}

std::vector<Journal::Record> kept_answers(const Results& grid, const CaseResult& planned, const EngineTable& engines,
                                          const GridOptions& options) {
  const Partition::OfCase shares =
      options.executor ? Partition(grid, kShares).cases()[index_of(planned, grid)] : Partition::OfCase();
  std::vector<Journal::Record> answers;
  for (const int share : options.executor ? shares_in(shares) : std::vector<int>{0}) {
    CaseResult own = planned;
    if (share != 0) leave_to_others(own, shares, share);
    const Journal journal(journal_of(planned, grid, share, options), plan_of(grid, own, engines, options));
    for (const auto& [job, record] : journal.found()) {
      if (job != Journal::kTruth) answers.push_back(record);
    }
  }
  return answers;
}

PathsOfCells paths_in(const CaseResult& planned, const std::vector<Journal::Record>& answers) {
  PathsOfCells paths;
  CaseResult scratch = planned;
  for (const Journal::Record& answer : answers) {
    const MessageSubject subject = apply_message(scratch, answer.message);
    if (!answer.path.empty()) paths[subject.index] = unpacked(answer.path);
  }
  return paths;
}

void forget_what_is_wrong(Journal& journal, const Results& grid, const CaseResult& planned, const EngineTable& engines,
                          const GridOptions& options) {
  CaseResult scratch = planned;
  journal.forget_if([&](const Journal::Record& record) {
    try {
      const MessageSubject subject = apply_message(scratch, record.message);
      if (subject.part != MessageSubject::Part::cell) return false;
      const Cell& cell = scratch.cells[subject.index];
      if (may_end_otherwise(cell, grid, engines)) return true;
      return std::any_of(options.recorders.begin(), options.recorders.end(),
                         [&](const auto& recorder) { return !recorder->still_has(cell); });
    } catch (const std::exception&) {
      return true;
    }
  });
}

}  // namespace rigor::inline runner
