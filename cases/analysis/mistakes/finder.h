// What known mistake an engine's error looks like: the engine's motion on a few scenes beside that of the core with
// each mistake of the table (adapters/faults/faults.h) in it, by any amount, and with pairs of them.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cases/analysis/mistakes/ranking.h"

namespace rigor {

struct MistakeReport {
  // right: no error is seen beyond what the engine's scheme makes. named: one suspect is first by far. alike: several
  // that move alike in all cases are. unnamed: no known mistake fits. untried: no motion of the engine is to be had.
  enum class Verdict { right, named, alike, unnamed, untried } verdict = Verdict::right;
  struct Named {
    std::vector<std::string> names;  // two for a pair
    double explains = 0;             // 0..1
    std::size_t explained = 0;       // of `cases`
    std::vector<CaseShare> cases;
  };
  std::vector<Named> suspects;        // the first few, best first
  std::size_t known = 0;              // mistakes in the table
  std::size_t leaders = 0;            // of `suspects`, those that the verdict means
  std::vector<std::string> off;       // the cases where the engine is off
  std::vector<std::string> seen;      // all cases on which it was seen
  std::vector<std::string> failures;  // what it could not be seen on, and why
  std::string beside;                 // what it was held against
};

class MistakeFinder {
 public:
  struct Options {
    int at_once = 1;
    double limit = 10;  // s of CPU time for a run
  };
  MistakeFinder(const EngineTable& engines, RunName run, std::vector<ProbeScene> probes, Options options);

  // Of the run's engine; `engine` behaves as that one should.
  MistakeReport report(const Engine& engine);

 private:
  // What does not depend on the engine's motion, for one choice of bases.
  struct Table {
    std::vector<View> views;
    std::vector<Sight> bases;
    std::vector<Observation> observations;
    std::vector<Hypothesis> hypotheses;
  };
  std::vector<Sight> sights(const Table& table, const Engine* engine, std::shared_ptr<const Fault> fault) const;
  void add_chaos(const Table& table, const Engine& engine, std::vector<Sight>& moved) const;
  std::vector<Hypothesis> simulated(const Table& table, std::vector<Hypothesis> hypotheses) const;
  RunName nearest_method(const Engine& engine);
  const Table& table_for(const RunName* of_points);
  void add_amounts(const Trace& trace, const Table& table, std::vector<Hypothesis>& hypotheses) const;
  void add_pairs(const Trace& trace, const Table& table, std::vector<Hypothesis>& hypotheses) const;

  const EngineTable& engines_;
  RunName run_;
  std::vector<ProbeScene> probes_;
  Options options_;
  std::map<std::string, Table> tables_;  // by the base of Kind::same_method
};

}  // namespace rigor
