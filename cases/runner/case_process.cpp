#include "cases/runner/case_process.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>

#include "cases/case/recording/recording_reader.h"
#include "cases/results/result_json.h"
#include "cases/runner/ensemble.h"
#include "cases/runner/executor.h"
#include "cases/runner/journal/case_journal.h"
#include "cases/runner/shards/shard.h"
#include "cases/runner/stable_step.h"
#include "cases/runner/trials/trials.h"
#include "cases/truth/recorded/recorded_motion.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline runner {

Status status_of(FailureKind kind) {
  switch (kind) {
    case FailureKind::unsupported:
      return Status::unsupported;
    case FailureKind::diverged:
      return Status::diverged;
    case FailureKind::crashed:
      return Status::crashed;
    case FailureKind::timed_out:
      return Status::timed_out;
    case FailureKind::invalid:
      break;
  }
  return Status::invalid;
}

namespace {

Cell cell_that_ended(Cell cell, const JobEnd& end, double limit) {
  cell.reason = sentence_of(end, limit);
  cell.status = end.how == Ending::refused     ? Status::invalid
                : end.how == Ending::timed_out ? Status::timed_out
                                               : Status::crashed;
  cell.trajectory.clear();
  cell.wall_seconds = end.seconds;
  return cell;
}

// How long a step has to hold to be called stable [s]: even where the run is short.
double stability_horizon(const Case& definition) { return std::max(30.0, definition.duration); }

// In a jointed scene an adaptive method takes the same number of inner steps at any dt. The search is therefore limited
// to the run's own duration.
double stability_horizon(const Case& definition, const MethodInfo& method) {
  return method.adaptive && !definition.scene.joints.empty() ? definition.duration : stability_horizon(definition);
}

// A truth need not hold that long where no stable step is searched for.
bool searches_steps(const CaseResult& planned, const GridOptions& options) {
  const auto& steps = planned.stable_steps;
  // The time of another shard's search also counts, because the truth must be the same in all shards.
  return options.stable_steps && std::any_of(steps.begin(), steps.end(), [](const auto& stable) {
           return stable.status != Status::unsupported || stable.skipped == SkipReason::another_shard;
         });
}

// The jobs of one case: first the cells, then the searches for stable steps. If a run timed out at one step, finer
// steps are not started. If it timed out at the coarsest step, no stable step is searched.
class CaseJobs {
 public:
  CaseJobs(const Results& grid, const CaseResult& planned, const EngineTable& engines, const GridOptions& options,
           const Truth* truth, const TruthFacts& facts)
      : grid_(grid),
        planned_(planned),
        engines_(engines),
        options_(options),
        truth_(truth),
        facts_(facts),
        heard_(planned) {
    const Case& definition = planned.definition;
    if (searches_steps(planned, options)) stable_energy_ = energy_of_stable_runs(definition);
    const std::size_t of_case = static_cast<std::size_t>(&planned - grid.cases.data());
    for (std::size_t i = 0; i < planned.cells.size(); ++i) {
      const Cell& cell = planned.cells[i];
      if (cell.status != Status::unsupported)
        jobs_.push_back({JobSpec::Kind::cell, of_case, options.limit, i, grid.runs[cell.run].text, cell.dt});
    }
    for (std::size_t run = 0; run < planned.stable_steps.size(); ++run) {
      if (planned.stable_steps[run].status != Status::unsupported)
        jobs_.push_back({JobSpec::Kind::stable_step, of_case, options.limit, run, grid.runs[run].text});
    }
  }

  // Those in the journal have run already.
  void run(const Channel& channel, Journal& journal) {
    std::vector<std::size_t> left;
    std::vector<JobSpec> jobs;
    for (std::size_t job = 0; job < jobs_.size(); ++job) {
      const auto kept = journal.found().find(job);
      if (kept == journal.found().end()) {
        left.push_back(job), jobs.push_back(jobs_[job]);
      } else {
        hear(job, kept->second), channel.send(kept->second.message);
      }
    }
    keep_truth_for(jobs);
    if (planned_.definition.ensemble > 0 && std::any_of(jobs.begin(), jobs.end(), is_cell))
      reference_.emplace(engines_, planned_.definition);
    std::map<std::size_t, std::string> flaws;  // by job; empty for one whose answer is good
    const auto on_message = [&](std::size_t index, const std::string& message) {
      const std::size_t job = left[index];
      if (flaws.contains(job)) return;  // a job answers once
      const Journal::Record record = parted(message);
      Status status = Status::crashed;
      try {
        status = hear(job, record);
        flaws[job] = "";
      } catch (const std::exception& error) {
        flaws[job] = fmt::format("its message could not be read: {}", error.what());
        return;
      }
      // Kept before it is told, so that what was told need not be done again.
      if (status != Status::timed_out) journal.add(job, record);  // with more time it is tried
      channel.send(record.message);
    };
    const auto on_end = [&](std::size_t index, JobEnd end) {
      const auto flaw = flaws.find(left[index]);
      if (flaw != flaws.end() && flaw->second.empty()) return;
      if (flaw != flaws.end()) end.how = Ending::threw, end.text = flaw->second;
      if (end.how == Ending::timed_out) note_time_out(jobs_[left[index]]);
      channel.send(message_of_failure(jobs_[left[index]], end));
    };
    const auto work = [&](const JobSpec& job, const Channel& to) {
      if (const std::string why = why_hopeless(job); !why.empty())
        return to.send(joined({message_of_failure(job, Status::timed_out, why), ""}));
      try {
        is_cell(job) ? do_cell(job, to) : do_stable_step(job, to);
      } catch (const EngineFailure& failure) {
        to.send(joined({message_of_failure(job, status_of(failure.kind()), failure.what()), ""}));
      }
      engines_.rest();
    };
    ProcessExecutor(options_.jobs).run(jobs, work, on_message, on_end);
    channel.send(message_of_spreads(spreads_of(planned_, paths_)));
  }

 private:
  const RunName& run_of(std::size_t index) const { return grid_.runs[index]; }

  static bool is_cell(const JobSpec& job) { return job.kind == JobSpec::Kind::cell; }
  static MessageSubject subject_of(const JobSpec& job) {
    return {is_cell(job) ? MessageSubject::Part::cell : MessageSubject::Part::stable_step, job.part};
  }

  // If nothing touches, a finer step takes longer. Among deeply overlapping bodies a coarse step may take longer.
  void note_time_out(const JobSpec& job) {
    if (!is_cell(job) || anything_can_touch(planned_.definition.scene)) return;
    const auto [known, is_new] = out_of_time_.try_emplace(job.run, job.dt);
    if (!is_new && known->second.seconds < job.dt.seconds) known->second = job.dt;
  }
  // Why a job is not begun; empty if it is.
  std::string why_hopeless(const JobSpec& job) const {
    const auto known = out_of_time_.find(job.run);
    if (known == out_of_time_.end()) return "";
    const double limit = known->second.seconds;
    const auto& steps = planned_.definition.dt;
    const bool was_coarsest =
        std::none_of(steps.begin(), steps.end(), [&](const auto& dt) { return dt.seconds > limit; });
    if (is_cell(job) ? !(job.dt.seconds < limit) : !was_coarsest) return "";
    return fmt::format("not tried: at {} s there was no result within the limit of {:g} s{}", known->second.text,
                       job.limit, is_cell(job) ? ", and this step takes longer" : "");
  }

  // At the steps that two cells or more are left to do at.
  void keep_truth_for(const std::vector<JobSpec>& jobs) {
    if (!truth_) return;
    std::map<double, int> cells;
    for (const JobSpec& job : jobs) {
      if (!is_cell(job) || ++cells[job.dt.seconds] != 2) continue;
      const Case& definition = planned_.definition;
      truth_on_steps_.keep(*truth_, job.dt.seconds, definition.duration, definition.scene.bodies.size());
    }
  }

  // J, the truth's energy in play over the stability horizon.
  double energy_of_stable_runs(const Case& definition) const {
    const double horizon = stability_horizon(definition);
    const bool is_jointed = !definition.scene.joints.empty();
    const double known = std::max(facts_.largest_kinetic_energy, facts_.largest_energy_change);
    if (truth_ && horizon == definition.duration) return known;
    const EnergyExtremes extremes = energy_extremes(definition.scene, is_jointed ? nullptr : truth_, horizon);
    return std::max({extremes.kinetic, extremes.change, is_jointed ? known : 0});
  }

  void do_stable_step(const JobSpec& job, const Channel& channel) const {
    const Case& definition = planned_.definition;
    const RunName& run = run_of(job.part);
    StableStepResult found;
    const MethodInfo& method = method_of(engines_.info_of(run.engine), run.settings);
    found.step = largest_stable_dt(find_engine(engines_, run.engine), run.settings, definition.scene,
                                   stability_horizon(definition, method), stable_energy_);
    found.status = Status::pass, found.reason = found.step.cut;
    channel.send(message_of_stable_step(job.part, found));
  }

  void do_cell(const JobSpec& job, const Channel& channel) const {
    const Cell& cell = planned_.cells[job.part];
    // A file that an earlier run left may also be one of the published outputs, by a hard link: it is not overwritten.
    for (const auto& recorder : options_.recorders) recorder->discard(cell);
    const JudgedCell judged = run_cell(cell, planned_.definition, engines_, run_of(cell.run), truth_, facts_, options_,
                                       truth_on_steps_, reference_ ? &*reference_ : nullptr);
    channel.send(joined({message_of_cell(job.part, judged.cell, planned_.definition.scene),
                         options_.spreads ? packed(judged.path) : ""}));
  }

  std::string message_of_failure(const JobSpec& job, const JobEnd& end) const {
    const Cell planned = is_cell(job) ? planned_.cells[job.part] : Cell();
    const Cell failed = cell_that_ended(planned, end, job.limit);
    return message_of_failure(job, failed);
  }
  // Of a job whose engine said so, and whose process goes on.
  std::string message_of_failure(const JobSpec& job, Status status, const std::string& why) const {
    Cell failed = is_cell(job) ? planned_.cells[job.part] : Cell();
    failed.status = status, failed.reason = why, failed.trajectory.clear();
    return message_of_failure(job, failed);
  }
  std::string message_of_failure(const JobSpec& job, const Cell& failed) const {
    if (!is_cell(job)) return message_of_stable_step(job.part, {failed.status, failed.reason, {}});
    const Cell& planned = planned_.cells[job.part];
    for (const auto& recorder : options_.recorders) recorder->discard(planned);
    return message_of_cell(job.part, failed, planned_.definition.scene);
  }

  // The one message of a job: its result and, after a zero byte, which JSON never contains, the path.
  static std::string joined(const Journal::Record& record) { return record.message + '\0' + record.path; }
  static Journal::Record parted(const std::string& message) {
    const std::size_t zero = std::min(message.find('\0'), message.size());
    return {message.substr(0, zero), message.substr(std::min(zero + 1, message.size()))};
  }

  // Throws for an answer that the grid's process could not read, or that is about another job than its own. Keeps a
  // path.
  Status hear(std::size_t job, const Journal::Record& record) {
    const MessageSubject subject = apply_message(heard_, record.message);
    if (subject != subject_of(jobs_[job])) throw std::runtime_error("it is about another cell");
    if (subject.part != MessageSubject::Part::cell) return heard_.stable_steps[subject.index].status;
    const Cell &planned = planned_.cells[subject.index], &heard = heard_.cells[subject.index];
    if (!heard.trajectory.empty() && heard.trajectory != planned.trajectory)
      throw std::runtime_error("it names another trajectory");
    const Status status = heard.status;
    heard_.cells[subject.index] = planned;  // its recordings are large
    if (record.path.empty()) return status;
    Path path = unpacked(record.path);
    if (path.bodies != planned_.definition.scene.bodies.size()) throw std::runtime_error("its path has other bodies");
    paths_[subject.index] = std::move(path);
    return status;
  }

  const Results& grid_;
  const CaseResult& planned_;
  const EngineTable& engines_;
  const GridOptions& options_;
  const Truth* truth_;
  TruthOnSteps truth_on_steps_;
  std::optional<EnsembleReference> reference_;
  TruthFacts facts_;
  double stable_energy_ = 0;  // J, the truth's energy in play over the stability horizon
  std::vector<JobSpec> jobs_;
  std::map<std::string, StepSize> out_of_time_;  // by run: the coarsest step at which it was
  CaseResult heard_;                             // of the received messages, to check whether they are readable
  PathsOfCells paths_;
};

std::size_t jobs_in(const CaseResult& planned) {
  const auto is_one = [](const auto& part) { return part.status != Status::unsupported; };
  return std::count_if(planned.cells.begin(), planned.cells.end(), is_one) +
         std::count_if(planned.stable_steps.begin(), planned.stable_steps.end(), is_one);
}

}  // namespace

std::vector<Spread> spreads_of(const CaseResult& planned, const PathsOfCells& paths) {
  std::vector<Spread> found;
  const bool has_no_truth = planned.definition.truth == "none";
  std::map<std::size_t, double> finest;  // s, of a run
  for (const auto& [at, path] : paths) {
    const Cell& cell = planned.cells[at];
    const auto [known, is_new] = finest.try_emplace(cell.run, cell.dt.seconds);
    known->second = std::min(known->second, cell.dt.seconds);
  }
  for (const auto& [a, path_a] : paths) {
    for (auto later = paths.upper_bound(a); later != paths.end(); ++later) {
      const Cell &one = planned.cells[a], &other = planned.cells[later->first];
      const bool is_own_step = has_no_truth && one.run == other.run && other.dt.seconds == finest.at(one.run);
      if (one.dt != other.dt && !is_own_step) continue;
      Spread spread = spread_between(path_a, later->second);
      spread.first = one.run, spread.second = other.run, spread.dt = one.dt;
      found.push_back(spread);
    }
  }
  return found;
}

void run_case(const Results& grid, const CaseResult& planned, const EngineTable& engines, const GridOptions& options,
              const Channel& channel) {
  const Case& definition = planned.definition;
  if (!missing_recording(definition).empty()) return;
  Journal journal(journal_of(planned, grid, options.share, options), plan_of(grid, planned, engines, options));
  forget_what_is_wrong(journal, grid, planned, engines, options);
  const auto known_truth = journal.found().find(Journal::kTruth);
  const bool is_done = known_truth != journal.found().end() && journal.found().size() == 1 + jobs_in(planned);
  if (is_done) {
    channel.send(known_truth->second.message);
    return CaseJobs(grid, planned, engines, options, nullptr, {}).run(channel, journal);
  }
  // A jointed scene's truth is dear, and chaotic past what its case asks for.
  const bool is_long = searches_steps(planned, options) && definition.scene.joints.empty();
  const double seconds = is_long ? stability_horizon(definition) : definition.duration;
  const auto truth = truth_of(definition, seconds);
  TruthFacts facts = facts_of(definition, truth.get());
  if (truth) facts.recordings = recordings_of_truth(definition, *truth, facts, options.recorders);
  CaseJobs jobs(grid, planned, engines, options, truth.get(), facts);
  const std::string message = message_of_truth(facts);
  channel.send(message);  // from here on each job has its own limit
  if (known_truth == journal.found().end()) journal.add(Journal::kTruth, {message, ""});
  jobs.run(channel, journal);
}

}  // namespace rigor::inline runner
