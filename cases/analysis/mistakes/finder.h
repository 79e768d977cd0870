// Finds the known mistake that an engine's error looks like. The engine's motion on a few scenes is compared with the
// motion of the core with each mistake of the table (adapters/faults/faults.h), by any amount, and with pairs of them.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "cases/analysis/mistakes/laws.h"
#include "cases/analysis/mistakes/mistake_table.h"

namespace rigor::inline analysis {

struct MistakeReport {
  enum class Verdict {
    right,    // the engine has no error that its scheme does not make
    named,    // one suspect explains the error best by far
    alike,    // several do, because they move alike in all cases
    unnamed,  // no known mistake explains the error
    untried,  // no motion of the engine could be computed
  } verdict = Verdict::right;
  struct Named {
    std::vector<std::string> names;  // two for a pair
    double explains = 0;             // 0..1
    std::size_t explained = 0;       // of `cases`
    std::vector<CaseShare> cases;
  };
  std::vector<Named> suspects;        // the first few, best first
  std::size_t known = 0;              // mistakes in the table
  std::size_t leaders = 0;            // the number of suspects that the verdict means
  std::vector<std::string> off;       // the cases where the engine is wrong
  std::vector<std::string> seen;      // all cases that the engine ran
  std::vector<std::string> failures;  // the cases that it did not run, and why
  std::vector<LawDrift> laws;         // the conservation laws that its motion was compared with
  std::vector<std::string> by_twin;   // of `seen`, the cases where a twin repeats the engine's scheme
  std::string beside;                 // what it was held against
};

class MistakeFinder {
 public:
  struct Options {
    int at_once = 1;
    double limit = 10;                                         // s of CPU time for a run
    std::function<void(std::size_t motions)> on_motions = {};  // called with the number of finished motions
  };
  MistakeFinder(const EngineTable& engines, RunName run, std::vector<ProbeScene> probes, Options options);

  // `engine` stands for the run's engine: the engine itself, or one that a test has broken.
  MistakeReport report(const Engine& engine);

 private:
  std::vector<StateSeries> motions_of(const std::vector<MotionTask>& tasks, double limit) const;
  std::vector<Sight> sights(const MistakeTable& table, const Engine* engine, std::shared_ptr<const Fault> fault) const;
  void add_chaos(const MistakeTable& table, const Engine& engine, std::vector<Sight>& moved) const;
  // Simulates the views that a hypothesis has no sight of. `only_smooth`: of these, the views where nothing touches.
  std::vector<Hypothesis> simulated(const MistakeTable& table, std::vector<Hypothesis> hypotheses,
                                    bool only_smooth = false) const;
  RunName nearest_method(const Engine& engine);
  const MistakeTable& table_for(const RunName* of_points);
  void note_sights(const MistakeTable& table, const std::vector<Sight>& moved, MistakeReport& report) const;
  std::vector<LawDrift> law_drifts(const Engine& engine, const std::vector<std::string>& seen) const;
  std::vector<Hypothesis> larger_amounts(const Trace& trace, const MistakeTable& table) const;
  void add_amounts(const Trace& trace, const MistakeTable& table, std::vector<Hypothesis>& hypotheses) const;
  void add_pairs(const Trace& trace, const MistakeTable& table, std::vector<Hypothesis>& hypotheses) const;
  // The best first.
  std::vector<Suspect> ranked(const Trace& trace, const MistakeTable& table, std::vector<Hypothesis>& hypotheses) const;

  const EngineTable& engines_;
  RunName run_;
  std::vector<ProbeScene> probes_;
  Options options_;
  std::map<std::string, MistakeTable> tables_;  // by the base of Kind::same_method
  mutable std::size_t motions_ = 0;             // so far
};

}  // namespace rigor::inline analysis
