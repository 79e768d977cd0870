// What is measured of one run: a number, the instant at which it is worst, and its series over time.
#pragma once

#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cases/truth/truth.h"
#include "core/engine/trajectory.h"
#include "core/scene/scene.h"

namespace rigor::inline metric {

// The truth at the instants of a trajectory's samples, so that no metric recomputes it.
struct TruthSamples {
  std::vector<KeptBodies> bodies;  // one for each sample of the trajectory
  std::vector<double> error;       // the truth's own error at each, see Truth::error
  double largest_kinetic_energy;   // J, over the whole run
  const Truth* source = nullptr;   // the sampled truth, to evaluate between the first sample and the last
};

struct ComparedReactions;  // measures/joints/reaction_difference.h
// Joint loads by sample, shared by the metrics of force and couple; empty if the equations of motion do not determine
// them.
using ReactionsBySample = std::map<std::size_t, std::shared_ptr<const ComparedReactions>>;
struct ReactionsKnown {
  ReactionsBySample at_states, reported;
};

// The run's twin: its own scheme, repeated by the core (Engine::twin), at the instants of the run's samples. There are
// fewer samples if the twin blew up earlier, or was needed only while it is comparable with the run
// (runner/twin_run.h).
struct TwinRun {
  Trajectory trajectory;
  // The effect of rounding alone on the twin up to each sample: the largest distance from the same twin in rotated
  // worlds, where the motion is the same and every rounding differs. It never decreases. For the first samples, as many
  // as can be compared.
  std::vector<double> position_rounding;     // m
  std::vector<double> orientation_rounding;  // rad
};

// J, at each sample. The two differ where the velocity at that instant is not determined (measures/synchronised.h).
struct EnergyBounds {
  std::vector<double> least, most;
};
// Several metrics use the same energies, so they are computed once.
struct EnergiesKnown {
  std::map<double, EnergyBounds> by_stagger;         // of the run, see energies_of
  std::optional<std::vector<double>> of_truth = {};  // as far as the truth was sampled
};

struct Ensembles;  // measures/ensembles.h

// A run, ready to be judged. The trajectory ends before the first sample that is not finite.
struct JudgedRun {
  const Scene& scene;
  const Trajectory& trajectory;
  const TruthSamples* truth;      // null where the case has none
  double leapfrog_stagger;        // in steps, see MethodInfo
  const TwinRun* twin = nullptr;  // null for the core's own schemes, and where bodies can touch
  double cpu_seconds = std::numeric_limits<double>::quiet_NaN();  // s, of the run's steps
  double survived = std::numeric_limits<double>::quiet_NaN();     // s, until it blew up, or `duration`
  double duration = 0;                                            // s, of the case
  const Ensembles* ensembles = nullptr;                           // null where the case asks for none
  const Trajectory* again = nullptr;                              // the same run, loaded again; null if no gate asks
  mutable EnergiesKnown energies = {};                            // filled in by energies_of and energy_series
  mutable ReactionsKnown reactions = {};                          // filled in by largest_reaction_difference
};

// Where a metric is worst. Body kWorld: the system as a whole.
struct Instant {
  double time = 0;  // s
  int body = kWorld;
  std::string component;  // the compared quantity: "position", "energy", "L.x"
  double found = 0, expected = 0;
};

struct Measurement {
  double value = 0;  // in the metric's unit
  Instant worst;
  std::vector<double> series;  // the value at each sample compared; may be shorter than the trajectory
  double compared_until = 0;   // s: the end of the run, or the horizon of the truth
};

// Either a measurement or the reason why there can be none.
struct MetricResult {
  std::optional<Measurement> measurement;
  std::string not_applicable;
};

// What a metric compares the run with, or asks of the engine, beside the run's own motion.
struct MetricNeeds {
  bool truth = false;  // its expected values come from the truth, always or in some scenes
  bool twin = false;   // the scheme replica (twin), see JudgedRun::twin
  bool ensemble = false;
  bool contacts = false;   // the engine's contact forces
  bool reactions = false;  // the joint reactions that the engine reports
};

// A row of the table in metrics.cpp. It states all that the program knows of a metric.
struct MetricRow {
  std::string name;
  std::string unit;     // "m", "rad", "1"
  std::string summary;  // one line
  MetricResult (*measure)(const JudgedRun& run);
  MetricNeeds needs = {.truth = true};
  bool higher_is_better = false;
  bool is_costly = false;   // many times a simulation's own work: measured only if a gate names it
  bool is_compared = true;  // by `rigor compare`; a measured time differs from run to run
  int headline = 0;         // its rank among the errors that summarise a case, from 1; 0: it is none
};

const std::vector<MetricRow>& metrics();                // alphabetical
const MetricRow* find_metric(const std::string& name);  // null if there is none
std::vector<std::string> metrics_that_need(bool MetricNeeds::*need);
const std::vector<std::string>& headline_metrics();  // by rank

// What is measured across the cells of a case; a gate may name it as it names a metric of one run.
struct CrossMetricRow {
  std::string name, unit, summary;
};

const std::vector<CrossMetricRow>& cross_metrics();  // alphabetical

// Looks in both kinds of metrics; empty if there is none of that name.
std::string unit_of_metric(const std::string& name);

}  // namespace rigor::inline metric
