// The truth "recording": measured motion. Between two samples the position is Hermite's cubic, with the measured
// velocities or else with those of a parabola through three samples, and the orientation turns evenly.
#pragma once

#include <memory>
#include <vector>

#include "cases/case/case.h"
#include "cases/case/recording/recording.h"
#include "cases/truth/truth.h"

namespace rigor::inline truth {

class RecordedMotion final : public Truth {
 public:
  // `scene` starts as the trial does. Keeps the recording.
  RecordedMotion(std::shared_ptr<const MotionRecording> recording, std::size_t trial, const Scene& scene);

  // Parts that were not measured keep their values of the scene.
  void at(double t, MutableBodyColumns out) const override;
  // The stated noise, plus the largest error of interpolation so far; infinite past the end of the trial.
  double error(double t) const override;
  std::string caveat() const override;

  const MotionRecording& recording() const { return *recording_; }
  const RecordedTrial& trial() const { return recording_->trials[trial_]; }
  // Whether t lies between two samples of the body that are no gap apart. A gap is longer than five usual intervals.
  bool is_measured(const RecordedBody& body, double t) const;

 private:
  struct Interval {
    std::size_t from;  // sample
    double s, h;       // share from 0 to 1; s
  };
  static Interval interval_of(const RecordedBody& body, double t);
  void keep_rates(const RecordedBody& body);
  void keep_errors(std::size_t index);

  std::shared_ptr<const MotionRecording> recording_;
  std::size_t trial_;
  BodyTable start_;
  // For each recorded body.
  std::vector<std::vector<Vec3>> velocities_, angular_velocities_;
  std::vector<double> longest_interval_;  // s, that is no gap
  std::vector<std::vector<double>>
      errors_;  // m and rad: the largest interpolation error up to the end of each interval
};

// The mean distance from a point of its measurements: noise alone makes an error of this many standard deviations.
// Independent normal errors along three axes have a distance with Maxwell's distribution, whose mean is 2 sqrt(2/pi).
inline constexpr double kMeanOfNoise = 1.5957691216057308;

// Null for a computed truth.
const RecordedMotion* as_recording(const Truth* truth);

// The truth of a case, computed or recorded; of a recording with trials the first. Null for "none".
std::unique_ptr<Truth> truth_of(const Case& definition, double duration);

// The case of one trial: its scene starts as the trial does, and it ends with the trial's last sample at the latest.
Case case_of_trial(const Case& definition, const MotionRecording& recording, std::size_t trial);

}  // namespace rigor::inline truth
