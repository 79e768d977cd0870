// What a tuning asks of the runner: some runs at some steps, on all cases, for a share of their duration.
#pragma once

#include <limits>
#include <set>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/tuning/tuning.h"

namespace rigor {

struct Probe {
  std::string run;
  std::size_t step;  // index in tuned_steps()
};

struct ProbeAnswer {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double error = kNone, cost = 0;  // as in TunedPoint
  std::string why;                 // of the first case without a result
  std::vector<double> values;      // of all bounds and cases, to tell whether two settings do the same
  double seconds = 0;              // that its longest cell took, with its judging
  bool is_late = false;            // a cell had no result within the limit
};

struct ProbeEffort {
  double share = 1;  // of each case's duration
  bool is_timed = false;
  int jobs = 1;                       // cells at once
  double limit = ProbeAnswer::kNone;  // s of CPU time for a cell; TuneOptions::limit holds as well
};

class Prober {
 public:
  Prober(const std::vector<Case>& cases, const std::vector<Bound>& bounds, const EngineTable& engines,
         const TuneOptions& options)
      : cases_(cases), bounds_(bounds), engines_(engines), options_(options) {}

  // One each of the probes, in their order.
  std::vector<ProbeAnswer> run(const std::vector<Probe>& probes, const ProbeEffort& effort);
  std::size_t runs() const { return runs_; }  // so far
  // Where the truth does not vouch for the whole run, a sentence each.
  const std::set<std::string>& remarks() const { return remarks_; }

 private:
  Results planned(const std::vector<Probe>& probes, double share) const;
  Cell cell_of(const Probe& probe, std::size_t run, const Results& grid, const CaseResult& result) const;
  void add(ProbeAnswer& answer, const CaseResult& result, const Cell& cell);

  const std::vector<Case>& cases_;
  const std::vector<Bound>& bounds_;
  const EngineTable& engines_;
  const TuneOptions& options_;
  std::size_t runs_ = 0;
  std::set<std::string> remarks_;
};

}  // namespace rigor
