#include "cases/runner/twin_run.h"

#include <algorithm>

#include "core/scene/contact_laws.h"
#include "core/scene/turned.h"

namespace rigor {
namespace {

// No axis of the old world lies along one of a new; all else about them is arbitrary. Several, for two runs' roundings
// can cancel by chance, and one pair would then show too little of them.
const Quat kTurns[] = {Quat(0.7, 0.3, -0.5, 0.4).normalized(), Quat(-0.2, 0.6, 0.5, 0.3).normalized(),
                       Quat(0.4, -0.3, 0.2, 0.8).normalized()};

Simulation simulate_twin(const EngineTable& engines, const RunName& twin, const Scene& scene, double dt,
                         double duration, long steps_per_sample) {
  return simulate(find_engine(engines, twin.engine), twin.settings, scene, dt, duration, steps_per_sample, false);
}

// Raises the twin's roundings to how far it is, at each sample, from itself in a world turned by `turn`. The twin ends
// where that one does.
void compare_with_turned(const Trajectory& turned_twin, const Quat& turn, TwinRun& twin) {
  auto& samples = twin.trajectory.samples;
  samples.resize(std::min(samples.size(), turned_twin.samples.size()));
  twin.position_rounding.resize(samples.size()), twin.orientation_rounding.resize(samples.size());
  double position = 0, orientation = 0;
  for (std::size_t n = 0; n < samples.size(); ++n) {
    const BodyColumns here = samples[n].bodies.columns(), there = turned_twin.samples[n].bodies.columns();
    for (std::size_t i = 0; i < here.size(); ++i) {
      position = std::max(position, (turn * here.position(i) - there.position(i)).norm());
      orientation = std::max(orientation, angle_between(turn * here.orientation(i), there.orientation(i)));
    }
    twin.position_rounding[n] = std::max(twin.position_rounding[n], position);
    twin.orientation_rounding[n] = std::max(twin.orientation_rounding[n], orientation);
  }
}

MetricValue measured(const std::string& name, const JudgedRun& run) {
  const auto row = std::find_if(metrics().begin(), metrics().end(), [&](const auto& r) { return r.name == name; });
  return condensed(row->measure(run), run.trajectory);
}

// The same scheme without its gyroscopic term, if it has one that is on.
std::optional<RunName> without_gyroscopic_term(RunName twin) {
  const auto option = twin.settings.options.find("gyroscopic");
  if (option == twin.settings.options.end() || option->second == "off") return {};
  option->second = "off";
  return twin;
}

}  // namespace

std::optional<RunName> twin_of(const EngineTable& engines, const RunName& run, const Scene& scene) {
  const std::string name = find_engine(engines, run.engine).twin(run.settings);
  if (name.empty() || anything_can_touch(scene)) return {};
  const RunName twin = parse_run_name(name, infos_of(engines));
  if (!why_unsupported(engines.info_of(twin.engine), twin.settings, scene, 0).empty()) return {};
  return twin;
}

TwinRun run_twin(const EngineTable& engines, const RunName& twin, const Scene& scene, const Simulation& run,
                 double duration) {
  const auto simulated = [&](const Scene& which) {
    return simulate_twin(engines, twin, which, run.trajectory.dt, duration, run.steps_per_sample).trajectory;
  };
  TwinRun out;
  out.trajectory = simulated(scene);
  auto& samples = out.trajectory.samples;
  samples.resize(std::min(samples.size(), run.trajectory.samples.size()));
  for (const Quat& turn : kTurns) compare_with_turned(simulated(turned(scene, turn)), turn, out);
  return out;
}

SchemeFindings judge_scheme(const EngineTable& engines, const RunName& twin, const JudgedRun& judged,
                            const Simulation& run, double duration) {
  SchemeFindings findings;
  findings.twin = twin.text;
  const JudgedRun as_run{judged.scene, judged.twin->trajectory, judged.truth, judged.leapfrog_stagger};
  for (const char* name : {"angular_momentum_drift", "energy_drift", "orientation_error", "position_error"}) {
    findings.metrics[name] = measured(name, as_run);
  }
  const auto without = without_gyroscopic_term(twin);
  if (!without) return findings;
  Simulation off_run =
      simulate_twin(engines, *without, judged.scene, run.trajectory.dt, duration, run.steps_per_sample);
  auto& samples = off_run.trajectory.samples;
  samples.resize(std::min(samples.size(), as_run.trajectory.samples.size()));  // the truth may have no more
  const JudgedRun off{judged.scene, off_run.trajectory, judged.truth, judged.leapfrog_stagger};
  for (const char* name : {"angular_momentum_drift", "energy_drift"}) {
    findings.without_gyroscopic_term[name] = measured(name, off);
  }
  return findings;
}

}  // namespace rigor
