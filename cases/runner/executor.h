// Runs the jobs of a grid: with processes on this machine here, or on several machines with another executor. A job is
// plain data, because each executor has planned the same grid.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "cases/case/case.h"
#include "cases/runner/process_pool.h"

namespace rigor::inline runner {

struct JobSpec {
  enum class Kind { whole_case, cell, stable_step };
  Kind kind;
  std::size_t of_case;    // index in Results::cases
  double limit;           // s, CPU time until its first message; none after that
  std::size_t part = 0;   // index in CaseResult::cells or stable_steps; of a case its share (shards/shard.h), 0: all
  std::string run = "";   // with its method and options, as it is named
  StepSize dt = {0, ""};  // of a cell
};

// The jobs of one call, handed out one by one as they start, so that they need not all be known at once.
class JobSource {
 public:
  virtual ~JobSource() = default;
  virtual std::optional<JobSpec> next() = 0;  // none: no further one will come
  virtual std::size_t left() const = 0;       // at most so many
};

class ListedJobs : public JobSource {
 public:
  explicit ListedJobs(const std::vector<JobSpec>& jobs) : jobs_(jobs) {}
  std::optional<JobSpec> next() override {
    if (next_ == jobs_.size()) return {};
    return jobs_[next_++];
  }
  std::size_t left() const override { return jobs_.size() - next_; }

 private:
  const std::vector<JobSpec>& jobs_;
  std::size_t next_ = 0;
};

class Executor {
 public:
  using Work = std::function<void(const JobSpec& job, const Channel& channel)>;
  using OnMessage = std::function<void(std::size_t job, const std::string& message)>;
  using OnEnd = std::function<void(std::size_t job, const JobEnd& end)>;

  virtual ~Executor() = default;
  // One process leads: it plans, judges and writes. Another process has planned the same grid, does the assigned jobs,
  // and leaves `run` through Dismissed.
  virtual bool leads() const { return true; }
  // Called once before `run`, with the plan, on which all processes must agree, and the folder that all must see.
  // Throws InputError otherwise.
  virtual void begin(const std::string& /*plan*/, const std::string& /*folder*/) const {}
  // Of a process that does not lead, and could not plan or has nothing to do: tells the one that does why; "": no
  // reason.
  virtual void stay_out(const std::string& /*why*/) const {}
  // Does each job in isolation, started in order; on_end is called once for each. Messages identify the job by its
  // place in that order, from 0. Throws Interrupted.
  virtual void run(JobSource& jobs, const Work& work, const OnMessage& on_message, const OnEnd& on_end) const = 0;
  void run(const std::vector<JobSpec>& jobs, const Work& work, const OnMessage& on_message, const OnEnd& on_end) const {
    ListedJobs listed(jobs);
    run(listed, work, on_message, on_end);
  }
};

// No more work is left for a process that does not lead.
struct Dismissed {};

// Hands an executor's jobs to run_jobs as they are asked for.
class FeedOfJobs : public JobFeed {
 public:
  FeedOfJobs(JobSource& jobs, const Executor::Work& work) : jobs_(jobs), work_(work), ahead_(jobs.next()) {}
  bool is_over() override { return !ahead_; }
  std::optional<Numbered> next() override {
    if (!ahead_) return {};
    const JobSpec job = *std::exchange(ahead_, jobs_.next());
    return Numbered{given_++, {[this, job](const Channel& channel) { work_(job, channel); }, job.limit}};
  }

 protected:
  // The next job with its number, to be done elsewhere. There is one.
  std::pair<std::size_t, JobSpec> give_away() { return {given_++, *std::exchange(ahead_, jobs_.next())}; }
  std::size_t left() const { return jobs_.left() + (ahead_ ? 1 : 0); }

 private:
  JobSource& jobs_;
  const Executor::Work& work_;
  std::optional<JobSpec> ahead_;
  std::size_t given_ = 0;
};

// Forks a child for each, as many at a time as it is told.
class ProcessExecutor : public Executor {
 public:
  using Executor::run;
  explicit ProcessExecutor(int at_once) : at_once_(at_once) {}
  void run(JobSource& jobs, const Work& work, const OnMessage& on_message, const OnEnd& on_end) const override {
    FeedOfJobs feed(jobs, work);
    run_jobs(feed, at_once_, on_message, on_end);
  }

 private:
  int at_once_;
};

}  // namespace rigor::inline runner
