#include "cases/laboratory/experiment.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "cases/metrics/stability.h"
#include "cases/runner/simulate.h"
#include "core/base/error.h"
#include "core/dynamics/model/energy.h"
#include "core/engine/engine_failure.h"
#include "core/engine/run_name.h"

namespace rigor::inline laboratory {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kManyBodies = 50;  // the overlaps of so many take long
constexpr double kMostKept = 4e5;        // states of bodies: 42 MB
// The metrics that explanations and the page read. They need neither a twin nor reports of contacts.
constexpr const char* kJudged[] = {"energy_drift",      "energy_drift_synchronised", "joint_gap",
                                   "orientation_error", "orthonormality_error",      "penetration",
                                   "position_error"};

}  // namespace

Experiment::Experiment(const EngineTable& engines, Scene scene, const std::string& run, double dt, double duration)
    : scene_(std::move(scene)), dt_(dt), duration_(duration), steps_(steps_in(duration, dt)) {
  const RunName name = parse_run_name(run, engines.infos());
  const EngineInfo& info = engines.info_of(name.engine);
  const std::string reason = why_unsupported(info, name.settings, scene_, dt);
  if (!reason.empty()) throw InputError(reason);
  name_ = name.text, stagger_ = method_of(info, name.settings).leapfrog_stagger;
  world_ = engines.find(name.engine).load(scene_, name.settings);
  const double states = static_cast<double>(steps_) * static_cast<double>(scene_.bodies.size());
  every_ = std::max(1L, std::lround(std::ceil(states / kMostKept)));
  kept_.dt = dt;
  for (const Joint& joint : scene_.joints) joints_.emplace_back(scene_, joint);
  world_->read(now_);
  record();
}

bool Experiment::step() {
  if (!why_ended_.empty()) return false;
  try {
    world_->step(dt_);
  } catch (const EngineFailure& failure) {
    return why_ended_ = failure.what(), false;
  } catch (const InputError& error) {
    return why_ended_ = error.what(), false;
  }
  world_->read(now_);
  if (const auto body = body_not_finite(now_.bodies())) {
    not_finite_ = NotFinite{now_.time, *body};
    why_ended_ = "the state of '" + scene_.bodies[*body].name + "' is no longer finite";
    return false;
  }
  record();
  if (static_cast<long>(readings_.size()) > steps_) why_ended_ = "the end of the run";
  return true;
}

void Experiment::record() {
  const auto step = static_cast<long>(readings_.size());
  readings_.push_back(read_now());
  note_error(readings_.size() - 1, now_.bodies(), readings_.back());
  if (step % every_ == 0 || step == steps_) kept_.samples.push_back({now_.time, KeptBodies(now_.bodies())});
}

LiveReading Experiment::read_now() const {
  LiveReading reading{now_.time, energy(scene_, now_.bodies()), 0, kUnknown, kUnknown, kUnknown};
  for (std::size_t i = 0; i < now_.bodies().size(); ++i) {
    const Mat3 R = now_.bodies().rotation(i);
    reading.orthonormality = std::max(reading.orthonormality, (R.transpose() * R - Mat3::Identity()).norm());
  }
  for (const JointGeometry& joint : joints_) reading.joint_gap = std::fmax(reading.joint_gap, joint.gap(now_.bodies()));
  return reading;
}

// No error is shown where the truth's own error is larger than a centimetre.
void Experiment::note_error(std::size_t step, BodyColumns bodies, LiveReading& reading) const {
  constexpr double kMostTruthError = 1e-2;  // m
  if (step >= truth_.rows() || truth_.error(step) > kMostTruthError) return;
  BodyTable due(truth_.bodies);
  truth_.read(step, due.columns());
  reading.position_error = reading.orientation_error = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (scene_.bodies[i].fixed) continue;
    const double far = (bodies.position(i) - std::as_const(due).columns().position(i)).norm();
    const double turned =
        angle_between(bodies.orientation(i).normalized(), std::as_const(due).columns().orientation(i).normalized());
    reading.position_error = std::max(reading.position_error, far);
    reading.orientation_error = std::max(reading.orientation_error, turned);
  }
}

void Experiment::compare_with(TruthTable truth) {
  if (truth.rows() > 0 && truth.bodies != scene_.bodies.size())
    throw InputError("the truth has other bodies than the scene");
  truth_ = std::move(truth);
  for (LiveReading& reading : readings_) reading.position_error = reading.orientation_error = kUnknown;
  for (const Sample& sample : kept_.samples) {
    const auto step = static_cast<std::size_t>(std::lround(sample.time / dt_));
    note_error(step, sample.bodies.columns(), readings_[step]);
  }
}

Cell Experiment::judge(bool brief) const {
  TruthSamples truth{{}, {}, truth_.kinetic};
  const bool has_truth = truth_.rows() > 0 && !truth_.is_provisional;
  for (const Sample& sample : kept_.samples) {
    const auto step = static_cast<std::size_t>(std::lround(sample.time / dt_));
    if (!has_truth || step >= truth_.rows()) break;
    truth_.read(step, truth.bodies.emplace_back(truth_.bodies).columns());
    truth.error.push_back(truth_.error(step));
  }
  const bool is_covered = has_truth && truth.bodies.size() == kept_.samples.size();
  JudgedRun judged{scene_, kept_, is_covered ? &truth : nullptr, stagger_};
  judged.duration = duration_;
  Cell found;
  const EnergyExtremes extremes =
      truth_.rows() > 0 ? EnergyExtremes{truth_.kinetic, truth_.change} : energy_extremes(scene_, nullptr, duration_);
  found.stability = judge_stability(judged, not_finite_, extremes.kinetic, extremes.change);
  judged.survived = found.stability.verdict == Verdict::blown_up ? found.stability.time : duration_;
  for (const char* name : kJudged) {
    if (brief && scene_.bodies.size() > kManyBodies && name == std::string("penetration")) continue;
    found.metrics[name] = condensed(find_metric(name)->measure(judged), kept_);
  }
  found.settings = world_->settings_in_force();
  const bool is_blown_up = found.stability.verdict == Verdict::blown_up;
  found.status = is_blown_up ? Status::diverged : Status::pass;
  found.reason = is_blown_up ? found.stability.why : "";
  return found;
}

}  // namespace rigor::inline laboratory
