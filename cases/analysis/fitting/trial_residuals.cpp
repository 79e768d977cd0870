#include "cases/analysis/fitting/trial_residuals.h"

#include <algorithm>

#include "cases/metrics/measures/recorded/recorded_gaps.h"
#include "cases/runner/simulate.h"
#include "cases/truth/solved/pose_interpolation.h"
#include "core/base/rotation_vector.h"

namespace rigor::inline analysis {
namespace {

// The run's state at t, which lies between its samples `n` and n + 1.
BodyState state_at(const Trajectory& run, std::size_t n, std::size_t body, double t) {
  const Sample &from = run.samples[n], &to = run.samples[n + 1];
  const double h = to.time - from.time;
  return between(from.bodies.columns().body(body), to.bodies.columns().body(body), h,
                 std::clamp((t - from.time) / h, 0.0, 1.0));
}

void append(std::vector<double>& all, const Vec3& gap, double noise) {
  for (int k = 0; k < 3; ++k) all.push_back(gap[k] / noise);
}

void compare(const Trajectory& run, const RecordedBody& body, const MotionRecording& recording, TrialResiduals& out) {
  constexpr double kRounding = 1e-4;  // of a step: times are written with a few digits
  const auto i = static_cast<std::size_t>(body.body);
  std::size_t n = 0;
  for (std::size_t k = 0; k < body.times.size(); ++k) {
    const double t = body.times[k];
    while (n + 2 < run.samples.size() && run.samples[n + 1].time < t) ++n;
    const double end = run.samples[n + 1].time;
    if (t > end + kRounding * (end - run.samples[n].time)) return;
    const BodyState pose = state_at(run, n, i, t);
    if (!body.positions.empty()) append(out.positions, pose.position - body.positions[k], recording.position_noise);
    if (!body.orientations.empty())
      append(out.rotations, rotation_vector_of(pose.orientation * body.orientations[k].conjugate()),
             recording.orientation_noise);
  }
}

}  // namespace

TrialResiduals trial_residuals(const Case& of_trial, const RecordedMotion& truth, const Engine& engine,
                               const Settings& settings, double dt) {
  const Simulation run = simulate(engine, settings, of_trial.scene, dt, of_trial.duration, {.is_timed = false});
  TrialResiduals residuals;
  if (run.not_finite || !run.solver_warning.empty() || !reaches_the_end(run.trajectory, truth, of_trial.duration))
    return residuals;
  residuals.has_result = true;
  for (const RecordedBody& body : truth.trial().bodies)
    if (!of_trial.scene.bodies[static_cast<std::size_t>(body.body)].fixed)
      compare(run.trajectory, body, truth.recording(), residuals);
  return residuals;
}

void move_start(Body& body, const StartShift& shift) {
  body.position += shift.position, body.velocity += shift.velocity;
  body.angular_velocity += shift.angular_velocity;
  body.orientation = (rotation_by(shift.turn) * body.orientation).normalized();
}

}  // namespace rigor::inline analysis
