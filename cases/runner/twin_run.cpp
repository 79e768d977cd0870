#include "cases/runner/twin_run.h"

#include <algorithm>
#include <memory>

#include "cases/metrics/measures/measuring.h"
#include "core/engine/remote.h"
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

// A world and where it stands, step by step.
class SteppedWorld {
 public:
  SteppedWorld(const Engine& engine, const Settings& settings, const Scene& scene, double dt, long steps)
      : world_(engine.load(scene, settings)), dt_(dt) {
    expect_steps(*world_, dt, steps, 1);
    world_->read(now_);
  }
  void step() { world_->step(dt_), world_->read(now_); }
  bool is_finite() const { return !body_not_finite(now_.bodies()); }
  double time() const { return now_.time; }
  BodyColumns bodies() const { return now_.bodies(); }

 private:
  std::unique_ptr<World> world_;
  double dt_;
  Snapshot now_;
};

// A twin beside itself in turned worlds, all at the same instant.
class TwinInTurnedWorlds {
 public:
  TwinInTurnedWorlds(const Engine& engine, const Settings& settings, const Scene& scene, double dt, long steps)
      : twin_(engine, settings, scene, dt, steps) {
    for (const Quat& turn : kTurns)
      turned_.push_back(std::make_unique<SteppedWorld>(engine, settings, rigor::turned(scene, turn), dt, steps));
  }

  void step() {
    twin_.step();
    for (const auto& turned : turned_) turned->step();
  }
  bool is_finite() const {
    return twin_.is_finite() &&
           std::all_of(turned_.begin(), turned_.end(), [](const auto& turned) { return turned->is_finite(); });
  }

  // Adds this instant, and how far the twin is from itself in the turned worlds, or has been before.
  void add_sample(TwinRun& out) {
    out.trajectory.samples.push_back({twin_.time(), BodyTable(twin_.bodies())});
    if (turned_.empty()) return;
    const BodyColumns here = twin_.bodies();
    for (std::size_t k = 0; k < turned_.size(); ++k) {
      const BodyColumns there = turned_[k]->bodies();
      for (std::size_t i = 0; i < here.size(); ++i) {
        position_ = std::max(position_, (kTurns[k] * here.position(i) - there.position(i)).norm());
        orientation_ = std::max(orientation_, angle_between(kTurns[k] * here.orientation(i), there.orientation(i)));
      }
    }
    out.position_rounding.push_back(position_), out.orientation_rounding.push_back(orientation_);
    for (std::size_t i = 0; i < here.size(); ++i) extent_ = std::max(extent_, here.position(i).norm());
  }

  // Roundings have parted the twin from itself by more than any comparison allows, see samples_with_twin().
  bool is_past_comparing() const {
    return !(position_ <= kRoundingShare * extent_) && !(orientation_ <= kRoundingShare);
  }
  void leave_turned_worlds() { turned_.clear(); }

 private:
  SteppedWorld twin_;
  std::vector<std::unique_ptr<SteppedWorld>> turned_;
  double position_ = 0, orientation_ = 0, extent_ = 0;  // m, rad, m
};

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
                 double duration, TwinLength length) {
  const double dt = run.trajectory.dt;
  const long steps = steps_in(duration, dt), every = run.steps_per_sample;
  TwinInTurnedWorlds worlds(find_engine(engines, twin.engine), twin.settings, scene, dt, steps);
  TwinRun out;
  out.trajectory.dt = dt;
  auto& samples = out.trajectory.samples;
  bool is_compared = true;
  for (long n = 0; worlds.is_finite(); ++n) {
    if (n % every == 0 || n == steps) {
      if (samples.size() == run.trajectory.samples.size()) break;
      worlds.add_sample(out);
      if (is_compared && (worlds.is_past_comparing() || samples.size() >= length.compared)) {
        if (!length.is_whole) break;
        is_compared = false;
        worlds.leave_turned_worlds();
      }
    }
    if (n == steps) break;
    worlds.step();
  }
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
