#include "cases/runner/twin_run.h"

#include <algorithm>

#include "core/scene/contact_laws.h"
#include "core/scene/turned.h"

namespace rigor {
namespace {

// No axis of the old world lies along one of the new; all else about it is arbitrary.
const Quat kTurn = Quat(0.7, 0.3, -0.5, 0.4).normalized();

Simulation simulate_twin(const EngineTable& engines, const RunName& twin, const Scene& scene, double dt,
                         double duration, long steps_per_sample) {
  return simulate(find_engine(engines, twin.engine), twin.settings, scene, dt, duration, steps_per_sample);
}

// The largest distance and angle between the twin and the turned twin, in the unturned world.
std::pair<double, double> distance(BodyColumns twin, BodyColumns turned_twin) {
  double position = 0, orientation = 0;
  for (std::size_t i = 0; i < twin.size(); ++i) {
    position = std::max(position, (kTurn * twin.position(i) - turned_twin.position(i)).norm());
    orientation = std::max(orientation, angle_between(kTurn * twin.orientation(i), turned_twin.orientation(i)));
  }
  return {position, orientation};
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
  if (name.empty() || anything_can_touch(scene) || !scene.joints.empty()) return {};
  return parse_run_name(name, infos_of(engines));
}

TwinRun run_twin(const EngineTable& engines, const RunName& twin, const Scene& scene, const Simulation& run,
                 double duration) {
  const double dt = run.trajectory.dt;
  Simulation straight = simulate_twin(engines, twin, scene, dt, duration, run.steps_per_sample);
  const Simulation turned_one = simulate_twin(engines, twin, turned(scene, kTurn), dt, duration, run.steps_per_sample);
  TwinRun out;
  auto& samples = straight.trajectory.samples;
  const auto& turned_samples = turned_one.trajectory.samples;
  const std::size_t count = std::min({samples.size(), turned_samples.size(), run.trajectory.samples.size()});
  samples.resize(count);
  double position = 0, orientation = 0;
  for (std::size_t n = 0; n < count; ++n) {
    const auto [metres, radians] = distance(samples[n].bodies.columns(), turned_samples[n].bodies.columns());
    position = std::max(position, metres), orientation = std::max(orientation, radians);
    out.position_rounding.push_back(position), out.orientation_rounding.push_back(orientation);
  }
  out.trajectory = std::move(straight.trajectory);
  return out;
}

SchemeFindings judge_scheme(const EngineTable& engines, const RunName& twin, const JudgedRun& judged,
                            const Simulation& run, double duration) {
  SchemeFindings findings;
  findings.twin = twin.text;
  const JudgedRun as_run{judged.scene, judged.twin->trajectory, judged.truth, judged.velocity_lag};
  for (const char* name : {"angular_momentum_drift", "energy_drift", "orientation_error", "position_error"}) {
    findings.metrics[name] = measured(name, as_run);
  }
  const auto without = without_gyroscopic_term(twin);
  if (!without) return findings;
  Simulation off_run =
      simulate_twin(engines, *without, judged.scene, run.trajectory.dt, duration, run.steps_per_sample);
  auto& samples = off_run.trajectory.samples;
  samples.resize(std::min(samples.size(), as_run.trajectory.samples.size()));  // the truth may have no more
  const JudgedRun off{judged.scene, off_run.trajectory, judged.truth, judged.velocity_lag};
  for (const char* name : {"angular_momentum_drift", "energy_drift"}) {
    findings.without_gyroscopic_term[name] = measured(name, off);
  }
  return findings;
}

}  // namespace rigor
