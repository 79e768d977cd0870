// Who runs the jobs of a grid: processes of this machine here; an executor that has several machines takes its place. A
// job is data, for whoever does it has planned the same grid.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "cases/case/case.h"
#include "cases/runner/process_pool.h"

namespace rigor {

struct JobSpec {
  enum class Kind { whole_case, cell, stable_step };
  Kind kind;
  std::size_t of_case;    // index in Results::cases
  double limit;           // s, CPU time until its first message; none after that
  std::size_t part = 0;   // index in CaseResult::cells or stable_steps; of a case its share (shards/shard.h), 0: all
  std::string run = "";   // with its method and options, as it is named
  StepSize dt = {0, ""};  // of a cell
};

class Executor {
 public:
  using Work = std::function<void(const JobSpec& job, const Channel& channel)>;
  using OnMessage = std::function<void(std::size_t job, const std::string& message)>;
  using OnEnd = std::function<void(std::size_t job, const JobEnd& end)>;

  virtual ~Executor() = default;
  // One process leads: it plans, judges and writes. Another one has planned the same, does what it is given, and leaves
  // `run` by Dismissed.
  virtual bool leads() const { return true; }
  // Once, before `run`: what was planned, which all have to agree on, and the folder that all have to see. Throws
  // InputError if they do not.
  virtual void begin(const std::string& /*plan*/, const std::string& /*folder*/) const {}
  // Of a process that does not lead, and could not plan or has nothing to do: tells the one that does why; "": no
  // reason.
  virtual void stay_out(const std::string& /*why*/) const {}
  // Does each job, apart from the others and from the caller, begun in their order; on_end is called once for each.
  // Throws Interrupted.
  virtual void run(const std::vector<JobSpec>& jobs, const Work& work, const OnMessage& on_message,
                   const OnEnd& on_end) const = 0;
};

// No more work is left for a process that does not lead.
struct Dismissed {};

// Forks a child for each, as many at a time as it is told.
class ProcessExecutor : public Executor {
 public:
  explicit ProcessExecutor(int at_once) : at_once_(at_once) {}
  void run(const std::vector<JobSpec>& jobs, const Work& work, const OnMessage& on_message,
           const OnEnd& on_end) const override {
    std::vector<Job> forked;
    for (const JobSpec& job : jobs)
      forked.push_back({[&work, &job](const Channel& channel) { work(job, channel); }, job.limit});
    run_jobs(forked, at_once_, on_message, on_end);
  }

 private:
  int at_once_;
};

}  // namespace rigor
