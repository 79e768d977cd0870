// One cell, from its simulation to its metrics: what case_process.h declares of it.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "cases/case/recording/recording_reader.h"
#include "cases/metrics/held_to_itself.h"
#include "cases/metrics/measures/joints/reaction_difference.h"
#include "cases/metrics/measures/measuring.h"
#include "cases/runner/case_process.h"
#include "cases/runner/ensemble.h"
#include "cases/runner/simulate.h"
#include "cases/runner/trials/trials.h"
#include "cases/runner/twin_run.h"
#include "cases/truth/provenance.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline runner {
namespace {

void conclude(Cell& cell, const Simulation& run, const Scene& scene) {
  if (cell.stability.verdict == Verdict::blown_up) {
    cell.status = Status::diverged;
    cell.reason = fmt::format("blown up at {:.2f} s: {}; {}", cell.stability.time, scene.body_name(cell.stability.body),
                              cell.stability.why);
    if (run.not_finite && !run.solver_warning.empty()) cell.reason += "; " + run.solver_warning;
  } else if (!run.solver_warning.empty()) {
    cell.status = Status::invalid;
    cell.reason = fmt::format("after {:.4g} s the method no longer met its promise: {}", run.solver_warning_time,
                              run.solver_warning);
  } else {
    cell.status = Status::pass;
    cell.reason.clear();
  }
}

using Names = std::vector<std::string>;

bool is_among(const Names& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

bool has_gate_on(const Case& definition, const Names& metrics) {
  return std::any_of(definition.gates.begin(), definition.gates.end(),
                     [&](const Gate& gate) { return is_among(metrics, gate.metric); });
}

bool has_option_for(const Names& metrics, const GridOptions& options) {
  return std::any_of(options.only_metrics.begin(), options.only_metrics.end(),
                     [&](const std::string& name) { return is_among(metrics, name); });
}

bool is_asked_for(const Names& metrics, const Case& definition, const GridOptions& options) {
  if (!options.only_metrics.empty()) return has_option_for(metrics, options);
  return options.is_thorough || has_gate_on(definition, metrics);
}

// Whether a metric with this need is measured.
bool is_needed(bool MetricNeeds::*need, const Case& definition, const GridOptions& options) {
  return is_asked_for(metrics_that_need(need), definition, options);
}

// A gate or an option can ask for it at any cost; in other thorough runs it is not to double the wait.
bool is_repeated(const Simulation& run, const Case& definition, const GridOptions& options) {
  constexpr double kQuick = 1;  // s of CPU time
  const Names repeats = {"repeats"};
  return is_asked_for(repeats, definition, options) &&
         (run.cpu_seconds < kQuick || has_gate_on(definition, repeats) || has_option_for(repeats, options));
}

// A case with gates says what it is about. One without, such as a user's own, is asked for its contact forces, too,
// unless it has so many bodies and steps that the records could fill the memory.
bool records_contacts(const Case& definition, double dt, const GridOptions& options) {
  if (!anything_can_touch(definition.scene)) return false;
  constexpr double kMostRecords = 250'000;  // bodies times steps; with 8 contacts of 100 bytes each, 200 MB
  const Names of_contacts = metrics_that_need(&MetricNeeds::contacts);
  if (has_gate_on(definition, of_contacts) || has_option_for(of_contacts, options)) return true;
  const bool says_nothing = definition.gates.empty() && options.only_metrics.empty();
  const double records = static_cast<double>(definition.scene.bodies.size()) * definition.duration / dt;
  return options.is_thorough && says_nothing && records <= kMostRecords;
}

// Steps from one whose reactions are asked for to the next, as far as the truth is good for; 0: none is.
long steps_between_reports(const Case& definition, double dt, const TruthFacts& facts, const GridOptions& options) {
  const bool is_wanted = options.only_metrics.empty() || is_needed(&MetricNeeds::reactions, definition, options);
  if (!is_wanted || !why_reactions_are_unknown(definition.scene).empty()) return 0;
  const long steps = steps_in(std::min(facts.horizon, definition.duration), dt);
  return static_cast<long>(samples_between_reactions(static_cast<std::size_t>(steps) + 1));
}

// Their series over time come out apart: no result keeps them.
std::map<std::string, MetricValue> measured(const JudgedRun& run, const RunName& name, const Case& definition,
                                            const GridOptions& options, std::vector<NamedSeries>& series) {
  std::map<std::string, MetricValue> values;
  for (const MetricRow& row : metrics()) {
    const bool is_wanted =
        is_asked_for({row.name}, definition, options) || (!row.is_costly && options.only_metrics.empty());
    MetricResult found = is_wanted ? row.measure(run) : MetricResult{{}, "not measured: no gate asks for it"};
    MetricValue& value = values[row.name] = condensed(found, run.trajectory);
    value.is_held_to_itself = is_case_held_to_itself(definition, row.name, name);
    if (found.measurement) series.push_back({row.name, std::move(found.measurement->series)});
  }
  return values;
}

}  // namespace

TruthFacts facts_of(const Case& definition, const Truth* truth) {
  TruthFacts facts;
  const EnergyExtremes extremes = energy_extremes(definition.scene, truth, definition.duration);
  facts.largest_kinetic_energy = extremes.kinetic, facts.largest_energy_change = extremes.change;
  facts.is_still = extremes.is_still;
  if (truth) {
    facts.error_at_end = truth->error(definition.duration);
    facts.horizon = horizon(*truth, kHorizonTolerance, definition.duration);
    facts.caveat = truth->caveat();
  }
  return facts;
}

namespace {

// Of one start.
JudgedCell run_once(const Cell& planned, const Case& definition, const EngineTable& engines, const RunName& run_name,
                    const Truth* truth, const TruthFacts& facts, const GridOptions& options,
                    const TruthOnSteps& truth_on_steps, const EnsembleReference* reference) {
  const auto begin = std::chrono::steady_clock::now();
  Cell cell = planned;
  const Scene& scene = definition.scene;
  const Engine& engine = find_engine(engines, run_name.engine);
  const double leapfrog_stagger = method_of(engines.info_of(run_name.engine), run_name.settings).leapfrog_stagger;
  const bool is_timed = is_asked_for({"cost"}, definition, options);
  const long reactions_every = truth ? steps_between_reports(definition, cell.dt.seconds, facts, options) : 0;
  const Simulation run = simulate(engine, run_name.settings, scene, cell.dt.seconds, definition.duration,
                                  {.is_timed = is_timed,
                                   .reactions_every = reactions_every,
                                   .has_contacts = records_contacts(definition, cell.dt.seconds, options)});
  if (!truth) check_start(run, scene);
  cell.settings = run.settings;
  cell.reduced_order = run.reduced_order;
  cell.sub_step = run.sub_step;
  cell.cpu_seconds = is_timed ? timed_again(engine, run_name.settings, scene, run) : run.cpu_seconds;
  std::optional<TruthSamples> samples;
  if (truth) {
    samples = truth_on_steps.at_samples_of(run.trajectory, *truth, scene.bodies.size(), facts.largest_kinetic_energy);
  }
  std::optional<RunName> twin_name;
  if (is_needed(&MetricNeeds::twin, definition, options)) twin_name = twin_of(engines, run_name, scene);
  JudgedRun judged{scene, run.trajectory, samples ? &*samples : nullptr, leapfrog_stagger, nullptr, cell.cpu_seconds};
  std::optional<TwinRun> twin;
  if (twin_name) {
    TwinLength length{.is_whole = options.is_thorough};
    if (judged.truth) length.compared = samples_within(judged, kTruthNeededPosition);
    twin = run_twin(engines, *twin_name, scene, run, definition.duration, length);
    judged.twin = &*twin;
  }
  judged.duration = definition.duration;
  cell.stability = judge_stability(judged, run.not_finite, facts.largest_kinetic_energy, facts.largest_energy_change);
  judged.survived = cell.stability.verdict == Verdict::blown_up ? cell.stability.time : definition.duration;
  std::optional<Ensembles> ensembles;
  const bool wants_ensembles = options.only_metrics.empty() || is_needed(&MetricNeeds::ensemble, definition, options);
  if (reference && wants_ensembles) ensembles = reference->compare(engines, run_name, definition, cell.dt.seconds);
  if (ensembles) judged.ensembles = &*ensembles;
  std::optional<Trajectory> again;
  if (is_repeated(run, definition, options)) {
    again = simulate(engine, run_name.settings, scene, cell.dt.seconds, definition.duration, {.is_timed = false})
                .trajectory;
    judged.again = &*again;
  }
  std::vector<NamedSeries> series;
  cell.metrics = measured(judged, run_name, definition, options, series);
  if (twin && options.is_thorough) cell.scheme = judge_scheme(engines, *twin_name, judged, run, definition.duration);
  conclude(cell, run, scene);
  for (const auto& recorder : options.recorders) {
    Recording kept = recorder->of_run(definition, cell, judged, series, facts);
    if (!kept.empty()) cell.recordings[recorder->name()] = std::move(kept);
  }
  cell.wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return {cell, options.spreads ? path_of(run.trajectory, definition.duration, scene.bodies.size()) : Path()};
}

}  // namespace

JudgedCell run_cell(const Cell& planned, const Case& definition, const EngineTable& engines, const RunName& run_name,
                    const Truth* truth, const TruthFacts& facts, const GridOptions& options,
                    const TruthOnSteps& truth_on_steps, const EnsembleReference* reference) {
  const auto recording = definition.recording;
  if (!recording || recording->trials.size() < 2)
    return run_once(planned, definition, engines, run_name, truth, facts, options, truth_on_steps, reference);
  JudgedCell judged = run_trials(
      definition, recording, options,
      [&](const Case& trial, const Truth& of_trial, const TruthFacts& facts_of_trial, const GridOptions& chosen) {
        return run_once(planned, trial, engines, run_name, &of_trial, facts_of_trial, chosen, {}, nullptr);
      });
  judged.cell.run = planned.run, judged.cell.dt = planned.dt, judged.cell.trajectory = planned.trajectory;
  return judged;
}

}  // namespace rigor::inline runner
