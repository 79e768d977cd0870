// Runs a tuning's probes: some runs at some steps, on all cases, for a share of their duration.
#pragma once

#include <limits>
#include <set>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/analysis/tuning/tuning.h"

namespace rigor::inline analysis {

struct Probe {
  std::string run;
  std::size_t step;  // index in tuned_steps()
};

struct ProbeAnswer {
  static constexpr double kNone = std::numeric_limits<double>::infinity();
  double error = kNone, cost = 0;  // as in TunedPoint
  std::string why;                 // of the first case without a result
  std::vector<double> values;      // of all bounds and cases; equal for settings with the same motion
  double seconds = 0;              // of its longest cell, judging included
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

  // One answer per probe, in their order.
  std::vector<ProbeAnswer> run(const std::vector<Probe>& probes, const ProbeEffort& effort);
  std::size_t runs() const { return runs_; }  // so far
  // One sentence per case whose truth does not cover the whole run.
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

}  // namespace rigor::inline analysis
