#include "cases/analysis/fitting/trial_error.h"

#include "cases/metrics/measures/measuring.h"
#include "cases/metrics/measures/recorded/recorded_gaps.h"
#include "cases/runner/simulate.h"

namespace rigor::inline analysis {
namespace {

class Gaps {
 public:
  void add(double gap) { sum_ += gap, squares_ += gap * gap, ++count_; }
  bool empty() const { return count_ == 0; }
  double mean() const { return empty() ? TrialError::kNone : sum_ / count_; }
  // A gap has three components.
  double square(double noise) const { return squares_ / (3 * noise * noise * count_); }

 private:
  double sum_ = 0, squares_ = 0;
  int count_ = 0;
};

TrialError error_of(const Gaps& positions, const Gaps& rotations, double position_noise, double orientation_noise) {
  TrialError error;
  error.position = positions.mean(), error.rotation = rotations.mean();
  double sum = 0;
  int parts = 0;
  if (!positions.empty()) sum += positions.square(position_noise), ++parts;
  if (!rotations.empty()) sum += rotations.square(orientation_noise), ++parts;
  if (parts > 0) error.square = sum / parts;
  return error;
}

TrialError against_recording(const Trajectory& run, const RecordedMotion& truth, double duration) {
  if (!reaches_the_end(run, truth, duration)) return {};
  Gaps positions, rotations;
  for (const RecordedGap& one : recorded_gaps(run, truth, RecordedPart::position)) positions.add(one.gap);
  for (const RecordedGap& one : recorded_gaps(run, truth, RecordedPart::orientation)) rotations.add(one.gap);
  return error_of(positions, rotations, truth.recording().position_noise, truth.recording().orientation_noise);
}

TrialError against_computed(const Trajectory& run, const Truth& truth) {
  Gaps positions, rotations;
  for (std::size_t n = 1; n < run.samples.size() && truth.error(run.samples[n].time) <= kTruthNeededPosition; ++n) {
    const BodyColumns found = run.samples[n].bodies.columns();
    BodyTable expected(found.size());
    truth.at(run.samples[n].time, expected.columns());
    for (std::size_t i = 0; i < found.size(); ++i) {
      positions.add((found.position(i) - expected.columns().position(i)).norm());
      rotations.add(angle_between(found.orientation(i), expected.columns().orientation(i)));
    }
  }
  return error_of(positions, rotations, kTruthNeededPosition, kTruthNeededOrientation);
}

}  // namespace

TrialError trial_error(const Case& of_trial, const Truth& truth, const Engine& engine, const Settings& settings,
                       double dt) {
  const Simulation run = simulate(engine, settings, of_trial.scene, dt, of_trial.duration, {.is_timed = false});
  if (run.not_finite || !run.solver_warning.empty()) return {};
  if (const RecordedMotion* recording = as_recording(&truth))
    return against_recording(run.trajectory, *recording, of_trial.duration);
  return against_computed(run.trajectory, truth);
}

}  // namespace rigor::inline analysis
