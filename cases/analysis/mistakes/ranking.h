// Which of many suspected mistakes explains an engine's error, and how well.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "cases/analysis/mistakes/evidence.h"

namespace rigor {

// A mistake, or two together, and how it moves in each view.
struct Hypothesis {
  std::shared_ptr<const Fault> fault;
  std::vector<std::string> names;  // one, or two
  std::vector<Sight> sights;       // one a view
};

struct CaseShare {
  std::string id;    // of a case where the engine is off
  double error = 0;  // how far, as a share of the motion
  double rest = 0;   // share of that which is left beside the mistake, 0..1
};

struct Suspect {
  std::size_t hypothesis;  // index
  double explains = 0;     // 0..1: 1 less the root of the mean square of what is left, over all observations
  std::vector<CaseShare> cases;
  std::size_t explained = 0;  // of `cases`, those where less than a hundredth is left
};

// What is seen of the engine under suspicion.
class Trace {
 public:
  // `is_single`: the engine holds its numbers in single precision.
  Trace(const std::vector<View>& views, const std::vector<Observation>& observations, std::vector<Sight> engine,
        bool is_single);

  // The best first; none that says nothing of any observation, and no pair of which one mistake does as well alone.
  std::vector<Suspect> ranked(const std::vector<Hypothesis>& hypotheses, const std::vector<ProbeScene>& probes) const;
  // Whether the engine's error passes what its scheme, rounding and the view leave open in any observation; with its
  // cases, by index.
  std::vector<std::size_t> probes_off(const std::vector<Hypothesis>& hypotheses) const;
  // The factor on this mistake's motion that comes nearest to the engine's, and the cosine of the two; 0 for none.
  struct Fit {
    double factor = 0, cosine = 0;
  };
  Fit fit(const Hypothesis& hypothesis) const;
  // What would be left of the error if the two mistakes' motions just added up, 0..1; for all pairs i < j.
  struct Sum {
    std::size_t first, second;
    double rest;
  };
  std::vector<Sum> sums(const std::vector<Hypothesis>& hypotheses) const;
  // Observations that this mistake alone explains to a hundredth, by index.
  std::vector<std::size_t> explained_by(const Hypothesis& hypothesis, const std::vector<Hypothesis>& all) const;

 private:
  Fit fit(const Hypothesis& hypothesis, bool of_contacts) const;
  bool is_seen(std::size_t observation) const;                                // the engine has a sight there
  bool is_seen(std::size_t observation, const Hypothesis& hypothesis) const;  // both have
  double tolerance(std::size_t observation) const;
  double certain_error(std::size_t observation) const;  // beyond it the engine is off whatever explains it
  // Of what is left there, for an error of this size.
  double weight_of(std::size_t observation, double size, const Sight& mistake) const;
  // 0..1, the root of the mean square over the observations that both say something of; adds the cases, by probe.
  double left_by(const Hypothesis& mistake, const Hypothesis& seen_with, const std::vector<double>& least,
                 std::map<std::size_t, CaseShare>* cases) const;
  // Whether one of a pair, or the best of all single ones, does as well over what the pair says something of: with a
  // mistake in what an engine tells that is less than what is seen of a single one.
  bool has_idle_second(const Suspect& suspect, const std::vector<Hypothesis>& hypotheses, const Hypothesis* best,
                       const std::vector<double>& least) const;
  // Of each observation, how near any hypothesis comes, the motion without mistakes included.
  std::vector<double> nearest(const std::vector<Hypothesis>& hypotheses) const;
  bool is_clear(std::size_t observation, double size, double nearest) const;
  // Whether it counts for and against mistakes. Where bodies touch, what no mistake comes near is the engine's own way.
  bool is_active(std::size_t observation, double size, double error, double nearest) const;

  const std::vector<View>& views_;
  std::vector<Observation> observations_;  // each until the engine's motion is lost
  std::vector<Sight> engine_;
  bool is_single_;
};

}  // namespace rigor
