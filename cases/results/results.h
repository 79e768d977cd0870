// What a run of the grid found: plain data, which the gates judge and the reports print.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "cases/case/case.h"
#include "cases/metrics/metric.h"
#include "cases/metrics/stability.h"
#include "cases/results/spread.h"
#include "core/engine/capabilities.h"
#include "core/engine/run_name.h"

namespace rigor::inline results {

// The end of a cell. invalid: the engine refused the scene, or its method did not keep its promise (an iteration that
// did not converge) in a run that did not blow up. A run that blew up is `diverged`, with or without a warning.
enum class Status { pass, fail, known_deviation, unexpected_pass, unsupported, diverged, crashed, timed_out, invalid };
std::string word_of(Status status);
Status status_of(const std::string& word);  // throws std::runtime_error for an unknown word

// Why a part of the grid is not run although its engine can run it. Its status is `unsupported`.
enum class SkipReason { not_asked_for, another_shard };
std::string word_of(SkipReason reason);

// A metric of one cell, without its series over time.
struct MetricValue {
  double value = 0;
  double first_second = 0;  // the largest, by magnitude, of its series up to t = 1 s; not a number if it has none
  Instant worst;
  double compared_until = 0;       // s
  std::string not_applicable;      // why there is no value; empty if there is
  bool is_held_to_itself = false;  // the truth is made by the run's own code: no witness (truth/provenance.h)
};

// A result without its series over time. `trajectory` is the one it was measured on.
MetricValue condensed(const MetricResult& result, const Trajectory& trajectory);

// The part of the error that the scheme itself makes, as its twin in the core shows. `twin` is empty if there is none.
struct SchemeFindings {
  std::string twin;                                            // the name of the core's run
  std::map<std::string, MetricValue> metrics;                  // of the twin, treated like a run
  std::map<std::string, MetricValue> without_gyroscopic_term;  // of the twin with that term off, where it is on
};

// A gate's answer for one cell, or for an order fitted over several. known_deviation: it failed, as the adapter's
// known_deviations.toml says. unexpected_pass: it held although it is listed there. not_recorded: a regression has no
// value for the cell.
enum class GateAnswer { held, failed, not_checked, known_deviation, unexpected_pass, not_recorded };
std::string word_of(GateAnswer answer);
bool is_failure(GateAnswer answer);  // whether `rigor gate` may not answer with exit code 0
struct GateResult {
  std::size_t gate = 0;  // index in Case::gates
  std::string engine;    // a run's name; empty if the gate met no cell at all
  std::string dt;        // as written; empty for an order
  GateAnswer answer = GateAnswer::not_checked;
  std::string text;                   // a sentence
  std::optional<double> value = {};   // in the metric's unit; none where there was nothing to judge
  std::optional<Instant> worst = {};  // where the metric has one
  std::string caveat = "";            // for `held`: the time over which the method was not tested; else empty
};

// What a recorder kept (runner/recorder.h): texts that only the report it belongs to reads.
using Recording = std::vector<std::string>;
using Recordings = std::map<std::string, Recording>;  // by the recorder's name

// case × engine × dt.
struct Cell {
  std::size_t run = 0;  // index in Results::runs
  StepSize dt;
  Status status = Status::crashed;
  std::string reason = "it did not run";  // the reason; empty for `pass`
  Stability stability;
  // The time from which the run used less than its method, if any. That part does not test the method.
  std::optional<ReducedOrder> reduced_order;
  std::optional<double> sub_step;              // s: the step really taken, where the method divides its steps
  std::map<std::string, MetricValue> metrics;  // by name; empty if the cell did not get so far
  SchemeFindings scheme;
  SettingsInForce settings;
  double cpu_seconds = 0;
  double wall_seconds = 0;  // of the whole cell: simulated, judged and written
  std::string trajectory;   // file name in trajectories/; empty if there is none
  Recordings recordings;
  std::optional<SkipReason> skipped = {};
};

struct StableStep {
  double dt = 0;          // s
  bool is_cap = false;    // still stable at the largest step tried: dt is that one
  bool is_floor = false;  // blows up at the smallest step tried: dt is that one
  std::string cut = "";   // what of the search was left out, and why; see largest_stable_dt
};

// The largest stable dt of a case and engine.
struct StableStepResult {
  Status status = Status::crashed;        // pass: `step` holds
  std::string reason = "it did not run";  // with `pass`: StableStep::cut
  StableStep step;
  std::optional<SkipReason> skipped = {};
};

// Leaves out a cell or a search for a stable step.
template <typename Part>
void skip(Part& part, SkipReason reason) {
  part.status = Status::unsupported, part.reason = word_of(reason), part.skipped = reason;
}

// The truth of a case, in numbers.
struct TruthFacts {
  double error_at_end = 0;            // of the truth itself: m and rad
  double horizon = 0;                 // s, to which that error stays below kHorizonTolerance
  double largest_kinetic_energy = 0;  // J
  double largest_energy_change = 0;   // J, from its start
  Recordings recordings = {};
  std::string caveat = {};  // see Truth::caveat()
  bool is_still = false;    // no body moves
};
inline constexpr double kHorizonTolerance = 1e-6;  // m and rad

struct CaseResult {
  Case definition;
  std::optional<TruthFacts> truth;  // none if it could not be had; for a case without truth only the energy counts
  std::string error;                // why the case could not be judged at all
  bool error_is_input = false;      // the case file asks for what cannot be
  std::vector<Cell> cells;          // by engine, then dt
  std::vector<StableStepResult> stable_steps;  // one each of Results::runs
  std::vector<Spread> spreads;                 // pairs of which one did not run are missing
  std::vector<GateResult> gates;
};

// The coarsest step of a case's run: the headline.
StepSize coarsest_dt(const CaseResult& result);

struct Results {
  std::vector<RunName> runs;
  std::vector<EngineInfo> engines;
  std::vector<CaseResult> cases;
  double wall_seconds = 0;
};

bool is_in_house(const Results& results, std::size_t run);  // see EngineInfo

}  // namespace rigor::inline results
