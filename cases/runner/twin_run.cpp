#include "cases/runner/twin_run.h"

#include <algorithm>
#include <memory>

#include "cases/metrics/measures/measuring.h"
#include "core/engine/engine.h"
#include "core/scene/contact_laws.h"
#include "core/scene/turned.h"

namespace rigor::inline runner {
namespace {

// No axis of the old world lies along one of a new world; otherwise the rotations are arbitrary. There are several,
// because the roundings of two runs can cancel by chance, and one pair would then show too little. The first alone
// suffices only if a hundred times its distance would still not matter.
const Quat kTurns[] = {Quat(0.7, 0.3, -0.5, 0.4).normalized(), Quat(-0.2, 0.6, 0.5, 0.3).normalized(),
                       Quat(0.4, -0.3, 0.2, 0.8).normalized()};

Simulation simulate_twin(const EngineTable& engines, const RunName& twin, const Scene& scene, double dt,
                         double duration, long steps_per_sample) {
  return simulate(find_engine(engines, twin.engine), twin.settings, scene, dt, duration,
                  {.steps_per_sample = steps_per_sample, .is_timed = false});
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

// The distance of a twin from itself in successive rotated worlds.
class TurnedTwin {
 public:
  TurnedTwin(std::unique_ptr<SteppedWorld> world, const Quat& turn) : world_(std::move(world)), turn_(turn) {}

  SteppedWorld& world() { return *world_; }

  // Raises the twin's rounding error at its n-th sample. samples_with_twin() checks whether it is still comparable.
  // Beyond that, neither positions nor orientations are compared.
  bool raise_rounding(std::size_t n, TwinRun& twin) {
    const BodyColumns here = twin.trajectory.samples[n].bodies.columns(), there = world_->bodies();
    for (std::size_t i = 0; i < here.size(); ++i) {
      position_ = std::max(position_, (turn_ * here.position(i) - there.position(i)).norm());
      orientation_ = std::max(orientation_, angle_between(turn_ * here.orientation(i), there.orientation(i)));
      extent_ = std::max(extent_, here.position(i).norm());
    }
    if (twin.position_rounding.size() == n) twin.position_rounding.push_back(0), twin.orientation_rounding.push_back(0);
    double &position = twin.position_rounding[n], &orientation = twin.orientation_rounding[n];
    position = std::max(position, position_), orientation = std::max(orientation, orientation_);
    largest_share_ = std::max({largest_share_, orientation, extent_ > 0 ? position / extent_ : 0});
    return position <= kRoundingShare * extent_ || orientation <= kRoundingShare;
  }

  // A hundred times the found distance would end no comparison, and a distance was found: another rotation is not
  // needed.
  bool is_far_from_mattering() const {
    constexpr double kFar = 0.01;
    return largest_share_ > 0 && largest_share_ < kFar * kRoundingShare;
  }

 private:
  std::unique_ptr<SteppedWorld> world_;
  Quat turn_;
  double position_ = 0, orientation_ = 0, extent_ = 0;  // m, rad, m
  double largest_share_ = 0;                            // of the roundings, of the extent and of one radian
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
  const auto world_in = [&](const Scene& which) {
    return std::make_unique<SteppedWorld>(find_engine(engines, twin.engine), twin.settings, which, dt, steps);
  };
  const auto is_sample = [&](long n) { return n % every == 0 || n == steps; };
  TwinRun out;
  out.trajectory.dt = dt;
  auto& samples = out.trajectory.samples;
  const auto own = world_in(scene);
  std::optional<TurnedTwin> first(std::in_place, world_in(turned(scene, kTurns[0])), kTurns[0]);
  bool is_compared = true;
  for (long n = 0; own->is_finite() && (!is_compared || first->world().is_finite()); ++n) {
    if (is_sample(n)) {
      if (samples.size() == run.trajectory.samples.size()) break;
      samples.push_back({own->time(), KeptBodies(own->bodies())});
      if (is_compared) is_compared = first->raise_rounding(samples.size() - 1, out) && samples.size() < length.compared;
      if (!is_compared && !length.is_whole) break;
    }
    if (n == steps) break;
    own->step();
    if (is_compared) first->world().step();
  }
  if (first->is_far_from_mattering()) return out;
  for (std::size_t k = 1; k < std::size(kTurns); ++k) {
    TurnedTwin other(world_in(turned(scene, kTurns[k])), kTurns[k]);
    std::size_t compared = 0;
    for (long n = 0; compared < out.position_rounding.size() && other.world().is_finite(); ++n) {
      if (is_sample(n) && !other.raise_rounding(compared++, out)) break;
      if (n < steps) other.world().step();
    }
    out.position_rounding.resize(compared), out.orientation_rounding.resize(compared);
    if (!length.is_whole || !other.world().is_finite()) samples.resize(std::min(samples.size(), compared));
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

}  // namespace rigor::inline runner
