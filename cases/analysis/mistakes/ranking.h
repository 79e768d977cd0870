// Ranks suspected mistakes by how well they explain an engine's error.
#pragma once

#include <map>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "cases/analysis/mistakes/evidence.h"

namespace rigor::inline analysis {

// A mistake, or two together, and its motion in each view.
struct Hypothesis {
  std::shared_ptr<const Fault> fault;
  std::vector<std::string> names;  // one, or two
  std::vector<Sight> sights;       // one a view
};

struct CaseShare {
  std::string id;    // a case where the engine is wrong
  double error = 0;  // as a share of the motion
  double rest = 0;   // the share of the error that the mistake leaves, 0..1
};

struct Suspect {
  std::size_t hypothesis;  // index
  double explains = 0;     // 0..1: 1 less the root mean square of the rests over all observations
  std::vector<CaseShare> cases;
  std::size_t explained = 0;  // the number of `cases` where less than a hundredth is left
};

// The motion of the engine under suspicion.
class Trace {
 public:
  // `is_single`: the engine holds its numbers in single precision.
  Trace(const std::vector<View>& views, const std::vector<Observation>& observations, std::vector<Sight> engine,
        bool is_single);

  // The best first. Left out: mistakes without any observation, and pairs of which one mistake alone does as well.
  std::vector<Suspect> ranked(const std::vector<Hypothesis>& hypotheses, const std::vector<ProbeScene>& probes) const;
  // The probes, by index, where the engine's error exceeds what its scheme, rounding and the view explain.
  std::vector<std::size_t> probes_off(const std::vector<Hypothesis>& hypotheses) const;
  // The factor on this mistake's motion that fits the engine's best, and the cosine of the two; 0 if there is none.
  struct Fit {
    double factor = 0, cosine = 0;
    bool is_smooth = false;  // found where nothing touches, because the mistake shows there
  };
  Fit fit(const Hypothesis& hypothesis) const;
  // Pairs to try, by index: those that explain different observations completely, those whose motions add up to the
  // error, and the best single mistake with any other.
  std::set<std::pair<std::size_t, std::size_t>> likely_pairs(const std::vector<Hypothesis>& all,
                                                             const std::vector<ProbeScene>& probes) const;

 private:
  // For all pairs i < j: the rest of the error, 0..1, if the motions of both mistakes simply added up.
  struct Sum {
    std::size_t first, second;
    double rest;
  };
  std::vector<Sum> sums(const std::vector<Hypothesis>& hypotheses) const;
  // The observations, by index, that this mistake alone explains to a hundredth.
  std::vector<std::size_t> explained_by(const Hypothesis& hypothesis, const std::vector<Hypothesis>& all) const;
  Fit fit(const Hypothesis& hypothesis, bool of_contacts) const;
  bool is_seen(std::size_t observation) const;                                // the engine has a sight there
  bool is_seen(std::size_t observation, const Hypothesis& hypothesis) const;  // both have one
  double tolerance(std::size_t observation) const;
  double certain_error(std::size_t observation) const;  // a larger error is certain even without an explanation
  // The weight of an observation with an error of this size.
  double weight_of(std::size_t observation, double size, const Sight& mistake) const;
  // 0..1: the root mean square over the observations of both. Adds the cases, by probe.
  double left_by(const Hypothesis& mistake, const Hypothesis& seen_with, const std::vector<double>& least,
                 std::map<std::size_t, CaseShare>* cases) const;
  // Whether one mistake of a pair, or the best single one, explains the pair's observations as well. A pair with a
  // mistake in reading has fewer observations than a single mistake.
  bool has_idle_second(const Suspect& suspect, const std::vector<Hypothesis>& hypotheses, const Hypothesis* best,
                       const std::vector<double>& least) const;
  // The smallest distance of any hypothesis in each observation. The motion without mistakes is one of them.
  std::vector<double> nearest(const std::vector<Hypothesis>& hypotheses) const;
  bool is_clear(std::size_t observation, double size, double nearest) const;
  // Whether the observation counts for and against mistakes. If bodies touch, an error that no mistake comes near is
  // the engine's own contact model.
  bool is_active(std::size_t observation, double size, double error, double nearest) const;

  const std::vector<View>& views_;
  std::vector<Observation> observations_;  // each until the engine's motion is lost
  std::vector<Sight> engine_;
  bool is_single_;
};

}  // namespace rigor::inline analysis
