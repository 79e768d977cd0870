// Runs a sweep: the process of a job, its messages, and the journal of finished jobs.
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <map>

#include "cases/analysis/sweep/sweep.h"
#include "cases/case/recording/recording_reader.h"
#include "cases/results/result_json.h"
#include "cases/runner/build_identity.h"
#include "cases/runner/case_process.h"
#include "cases/truth/recorded/recorded_motion.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace rigor::inline analysis {
namespace {

using Rows = std::vector<SweepRow>;

std::string message_of(std::size_t index, const SweepRow& row) { return fmt::format("{} {}", index, answer_of(row)); }

// Throws std::exception for a message that is about none of these rows.
void apply_row(Rows& rows, const std::string& message) {
  const std::size_t space = std::min(message.find(' '), message.size());
  apply_answer(rows.at(std::stoul(message.substr(0, space))), message.substr(space));
}

bool is_unheard(const SweepRow& row) { return row.status == Status::crashed && row.reason == SweepRow().reason; }

void fail(SweepRow& row, const JobEnd& end, double limit) {
  row.reason = sentence_of(end, limit);
  row.status = end.how == Ending::refused     ? Status::invalid
               : end.how == Ending::timed_out ? Status::timed_out
                                              : Status::crashed;
}

// Inside the process of one job.
class JobProcess {
 public:
  JobProcess(const Sweep& sweep, const EngineTable& engines, const SweepOptions& options, int jobs)
      : sweep_(sweep), engines_(engines), limit_(options.limit), jobs_(jobs) {
    grid_options_.stable_steps = grid_options_.is_thorough = grid_options_.spreads = false;
    if (sweep.asks_for_metrics()) grid_options_.only_metrics = sweep.metrics();
  }

  void run(std::size_t job, const Channel& channel) const {
    const Case definition = sweep_.definition_of(job);
    Rows rows = sweep_.rows_of(job);
    std::vector<std::size_t> left;
    const std::string missing = missing_recording(definition);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const std::string why = missing.empty() ? why_not(rows[i], definition.scene) : missing;
      if (why.empty()) {
        left.push_back(i);
      } else {
        rows[i].status = Status::unsupported, rows[i].reason = why;
        channel.send(message_of(i, rows[i]));
      }
    }
    if (left.empty()) return;
    const auto truth = truth_of(definition, definition.duration);
    const TruthFacts facts = facts_of(definition, truth.get());
    const auto work = [&](std::size_t i, const Channel& to) {
      judge(rows[i], definition, truth.get(), facts);
      to.send(message_of(i, rows[i]));
    };
    if (rows.size() == 1) return work(0, channel);  // this process is apart from others already
    run_apart(rows, left, work, channel);
  }

 private:
  std::string why_not(const SweepRow& row, const Scene& scene) const {
    try {
      const RunName run = sweep_.run_of(row);
      return why_unsupported(engines_.info_of(run.engine), run.settings, scene, row.dt.seconds);
    } catch (const InputError& error) {  // an option that this method does not have
      return error.what();
    }
  }

  void judge(SweepRow& row, const Case& definition, const Truth* truth, const TruthFacts& facts) const {
    Cell planned;
    planned.dt = row.dt;
    const Cell cell = run_cell(planned, definition, engines_, sweep_.run_of(row), truth, facts, grid_options_).cell;
    row.status = cell.status, row.reason = cell.reason, row.verdict = word_of(cell.stability.verdict);
    for (std::size_t i = 0; i < row.metrics.size(); ++i) {
      const auto found = cell.metrics.find(sweep_.metrics()[i]);
      if (found == cell.metrics.end() || !found->second.not_applicable.empty()) continue;
      row.metrics[i] = found->second.value;
      if (found->second.is_held_to_itself) row.held_to_itself.push_back(found->first);
    }
  }

  template <typename Work>
  void run_apart(Rows& rows, const std::vector<std::size_t>& left, const Work& work, const Channel& channel) const {
    channel.send("");  // the truth is made: from here on each cell has a limit of its own
    std::vector<JobSpec> jobs;
    for (const std::size_t i : left) jobs.push_back({JobSpec::Kind::cell, 0, limit_, i});
    std::vector<bool> heard(left.size());
    ProcessExecutor(jobs_).run(
        jobs, [&](const JobSpec& job, const Channel& to) { work(job.part, to); },
        [&](std::size_t job, const std::string& message) {
          try {
            apply_row(rows, message);
          } catch (const std::exception&) {
            return;  // as if it had not answered
          }
          heard[job] = true, channel.send(message);
        },
        [&](std::size_t job, const JobEnd& end) {
          if (heard[job]) return;
          fail(rows[left[job]], end, limit_);
          channel.send(message_of(left[job], rows[left[job]]));
        });
  }

  const Sweep& sweep_;
  const EngineTable& engines_;
  double limit_;
  int jobs_;
  GridOptions grid_options_;
};

// Passes rows on in order and keeps those that arrive early.
class InOrder {
 public:
  InOrder(std::size_t first, const std::function<void(const SweepRow&)>& on_row) : on_row_(on_row), next_(first) {}
  void add(std::size_t job, Rows rows) {
    early_[job] = std::move(rows);
    for (auto next = early_.find(next_); next != early_.end(); next = early_.find(next_)) {
      for (const SweepRow& row : next->second) on_row_(row);
      early_.erase(next);
      ++next_;
    }
  }

 private:
  const std::function<void(const SweepRow&)>& on_row_;
  std::map<std::size_t, Rows> early_;  // by job
  std::size_t next_;
};

// The rows of each open job, and the journal of complete jobs.
class SweepProgress {
 public:
  SweepProgress(const Sweep& sweep, const SweepOptions& options, const std::function<void(const SweepRow&)>& on_row)
      : sweep_(sweep),
        limit_(options.limit),
        journal_(options.journal, options.journal.empty() ? "" : build_identity() + "\n" + sweep.plan()),
        in_order_(jobs_of(sweep, options.shard).first, on_row) {}

  // Whether an earlier run has finished the job.
  bool take_from_journal(std::size_t job) {
    const auto kept = journal_.found().find(job);
    if (kept == journal_.found().end()) return false;
    Rows rows = sweep_.rows_of(job);
    try {
      for (const Json& message : parse_json(kept->second.message)) apply_row(rows, message.get<std::string>());
    } catch (const std::exception&) {
      return false;
    }
    if (std::any_of(rows.begin(), rows.end(), is_unheard)) return false;
    in_order_.add(job, std::move(rows));
    return true;
  }

  void hear(std::size_t job, const std::string& message) {
    if (message.empty()) return;
    Open& open = open_of(job);
    try {
      apply_row(open.rows, message);
      open.messages.push_back(message);
    } catch (const std::exception& error) {
      open.flaw = fmt::format("its message could not be read: {}", error.what());
    }
  }

  void end(std::size_t job, JobEnd end) {
    Open open = std::move(open_of(job));
    open_.erase(job);
    if (!open.flaw.empty()) end.how = Ending::threw, end.text = open.flaw;
    bool is_whole = end.how == Ending::finished;
    for (SweepRow& row : open.rows) {
      if (is_unheard(row)) fail(row, end, limit_), is_whole = false;
      is_whole &= row.status != Status::crashed && row.status != Status::timed_out;
    }
    if (is_whole) journal_.add(job, {text_of(Json(open.messages), -1), ""});
    in_order_.add(job, std::move(open.rows));
  }

 private:
  struct Open {
    Rows rows;
    std::vector<std::string> messages;
    std::string flaw;
  };
  Open& open_of(std::size_t job) {
    const auto [found, is_new] = open_.try_emplace(job);
    if (is_new) found->second.rows = sweep_.rows_of(job);
    return found->second;
  }

  const Sweep& sweep_;
  double limit_;
  Journal journal_;
  InOrder in_order_;
  std::map<std::size_t, Open> open_;
};

// The jobs of a shard that no earlier run has finished.
class JobsToDo : public JobSource {
 public:
  JobsToDo(const Sweep& sweep, std::pair<std::size_t, std::size_t> range, double limit, SweepProgress& progress)
      : sweep_(sweep), next_(range.first), behind_(range.second), limit_(limit), progress_(progress) {}

  std::optional<JobSpec> next() override {
    while (next_ < behind_ && progress_.take_from_journal(next_)) ++next_;
    if (next_ == behind_) return {};
    given_.push_back(next_++);
    return JobSpec{JobSpec::Kind::whole_case, given_.back(), limit_of(given_.back())};
  }
  std::size_t left() const override { return behind_ - next_; }
  std::size_t given(std::size_t number) const { return given_[number]; }

 private:
  // A job with a single row computes its truth and its cell under one limit.
  double limit_of(std::size_t job) const {
    const bool is_single = sweep_.first_row_of(job + 1) - sweep_.first_row_of(job) == 1;
    return is_single ? 2 * limit_ : limit_;
  }

  const Sweep& sweep_;
  std::size_t next_, behind_;
  double limit_;  // s
  SweepProgress& progress_;
  std::vector<std::size_t> given_;  // jobs of the sweep, in the order in which they were begun
};

}  // namespace

std::string answer_of(const SweepRow& row) {
  return text_of(Json::array({word_of(row.status), row.reason, row.verdict, row.metrics, row.held_to_itself}), -1);
}

void apply_answer(SweepRow& row, const std::string& answer) {
  const Json json = parse_json(answer);
  SweepRow heard = row;
  heard.status = status_of(json.at(0).get<std::string>());
  heard.reason = json.at(1).get<std::string>(), heard.verdict = json.at(2).get<std::string>();
  if (json.at(3).size() != heard.metrics.size()) throw std::runtime_error("it has other metrics");
  for (std::size_t i = 0; i < heard.metrics.size(); ++i) heard.metrics[i] = number_of(json.at(3).at(i));
  heard.held_to_itself = json.at(4).get<std::vector<std::string>>();
  row = std::move(heard);
}

std::pair<std::size_t, std::size_t> jobs_of(const Sweep& sweep, const Shard& shard) {
  // A job belongs to the shard in which it begins.
  const auto begin_of = [&](int index) {
    const double row = static_cast<double>(sweep.cells()) * (index - 1) / shard.count;
    std::size_t low = 0, high = sweep.jobs();
    while (low < high) {
      const std::size_t middle = (low + high) / 2;
      (static_cast<double>(sweep.first_row_of(middle)) < row ? low = middle + 1 : high = middle);
    }
    return low;
  };
  return {begin_of(shard.index), begin_of(shard.index + 1)};
}

void run_sweep(const Sweep& sweep, const EngineTable& engines, const SweepOptions& options,
               const std::function<void(const SweepRow& row)>& on_row) {
  const auto [first, behind] = jobs_of(sweep, options.shard);
  const int at_once = static_cast<int>(std::min<std::size_t>(static_cast<std::size_t>(options.jobs), behind - first));
  const JobProcess process(sweep, engines, options, options.jobs / std::max(1, at_once));
  const ProcessExecutor processes(at_once);
  const Executor& executor = options.executor ? *options.executor : processes;
  const auto work = [&](const JobSpec& job, const Channel& channel) { process.run(job.of_case, channel); };
  executor.begin(build_identity() + "\n" + sweep.plan(), std::filesystem::path(options.journal).parent_path().string());
  if (!executor.leads()) return executor.run(std::vector<JobSpec>(), work, {}, {});
  SweepProgress progress(sweep, options, on_row);
  JobsToDo jobs(sweep, {first, behind}, options.limit, progress);
  executor.run(
      jobs, work, [&](std::size_t job, const std::string& message) { progress.hear(jobs.given(job), message); },
      [&](std::size_t job, const JobEnd& end) { progress.end(jobs.given(job), end); });
}

}  // namespace rigor::inline analysis
