// Shares the jobs of a grid among the ranks of an MPI run: rank 0 leads and works too, the others ask for work as they
// end it. Each rank does its jobs in forked children, as on one machine. A rank has one thread, and none waits by
// spinning: there may be more ranks than cores.
#pragma once

#include <deque>
#include <string>
#include <vector>

#include "cases/runner/executor.h"

namespace rigor::inline cli {

class MpiExecutor : public Executor {
 public:
  MpiExecutor();            // MPI is initialised
  ~MpiExecutor() override;  // of the leader: dismisses the others
  bool leads() const override { return rank_ == 0; }
  void begin(const std::string& plan, const std::string& folder) const override;
  using Executor::run;
  void run(JobSource& jobs, const Work& work, const OnMessage& on_message, const OnEnd& on_end) const override;
  void stay_out(const std::string& why) const override;

 private:
  class Leading;
  class Helping;
  void lead_in(const std::string& plan, const std::string& folder) const;
  void join_in(const std::string& plan, const std::string& folder) const;
  std::string wait_for(int tag) const;  // of a helper; throws Dismissed
  void leave() const;                   // of a helper
  [[noreturn]] void refuse(int rank, const std::string& why) const;

  int rank_ = 0, ranks_ = 1;
  mutable bool has_told_ = false, is_dismissed_ = false;
  mutable std::deque<int> hungry_;  // ranks that asked for a job, once for each they can take
};

}  // namespace rigor::inline cli
