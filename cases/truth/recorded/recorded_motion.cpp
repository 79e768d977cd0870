#include "cases/truth/recorded/recorded_motion.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/case/recording/recording_reader.h"
#include "cases/truth/provenance.h"
#include "core/base/error.h"
#include "core/base/rotation_vector.h"

namespace rigor::inline truth {
namespace {

constexpr double kGap = 5;              // usual intervals; a camera that drops a few frames still follows the motion
constexpr double kTimeRounding = 1e-4;  // of an interval: times are written with a few digits

double usual_interval(const RecordedBody& body) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < body.times.size(); ++i) intervals.push_back(body.times[i] - body.times[i - 1]);
  const auto middle = intervals.begin() + static_cast<long>(intervals.size() / 2);
  std::nth_element(intervals.begin(), middle, intervals.end());
  return *middle;
}

// Rates at the samples: of the parabola through a sample and its neighbours. `step(i)` goes from sample i to i + 1.
template <typename Step>
std::vector<Vec3> rates_of(const std::vector<double>& times, const Step& step) {
  const std::size_t count = times.size();
  std::vector<Vec3> slopes, rates;
  for (std::size_t i = 0; i + 1 < count; ++i) slopes.push_back(step(i) / (times[i + 1] - times[i]));
  for (std::size_t i = 0; i < count; ++i) {
    if (i == 0 || i + 1 == count) {
      rates.push_back(slopes[i == 0 ? 0 : count - 2]);
      continue;
    }
    const double before = times[i] - times[i - 1], after = times[i + 1] - times[i];
    rates.push_back((after * slopes[i - 1] + before * slopes[i]) / (before + after));
  }
  return rates;
}

}  // namespace

RecordedMotion::RecordedMotion(std::shared_ptr<const MotionRecording> recording, std::size_t trial, const Scene& scene)
    : recording_(std::move(recording)), trial_(trial), start_(scene.bodies.size()) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    start_.columns().set_body(i, {body.position, body.orientation, body.velocity, body.angular_velocity});
  }
  for (const RecordedBody& body : this->trial().bodies) {
    keep_rates(body);
    longest_interval_.push_back(kGap * usual_interval(body));
    keep_errors(longest_interval_.size() - 1);
  }
}

void RecordedMotion::keep_rates(const RecordedBody& body) {
  std::vector<Vec3> velocities = body.velocities, turns = body.angular_velocities;
  if (velocities.empty() && !body.positions.empty())
    velocities = rates_of(body.times, [&](std::size_t i) -> Vec3 { return body.positions[i + 1] - body.positions[i]; });
  if (turns.empty() && !body.orientations.empty())
    turns = rates_of(body.times, [&](std::size_t i) {
      return rotation_vector_of(body.orientations[i + 1] * body.orientations[i].conjugate());
    });
  velocities_.push_back(std::move(velocities)), angular_velocities_.push_back(std::move(turns));
}

// An impact within an interval makes a kink. A path with a kink of the rates' difference is at most a quarter of it
// times the interval away from the chord, and the cubic lies between them.
void RecordedMotion::keep_errors(std::size_t index) {
  const RecordedBody& body = trial().bodies[index];
  double most = 0;
  std::vector<double> errors;
  for (std::size_t i = 0; i + 1 < body.times.size(); ++i) {
    const double h = body.times[i + 1] - body.times[i];
    for (const std::vector<Vec3>* rates : {&velocities_[index], &angular_velocities_[index]})
      if (!rates->empty()) most = std::max(most, 0.25 * h * ((*rates)[i + 1] - (*rates)[i]).norm());
    errors.push_back(most);
  }
  errors_.push_back(std::move(errors));
}

RecordedMotion::Interval RecordedMotion::interval_of(const RecordedBody& body, double t) {
  const auto behind = std::upper_bound(body.times.begin() + 1, body.times.end() - 1, t);
  const auto from = static_cast<std::size_t>(behind - body.times.begin()) - 1;
  const double h = body.times[from + 1] - body.times[from];
  return {from, std::clamp((t - body.times[from]) / h, 0.0, 1.0), h};
}

void RecordedMotion::at(double t, MutableBodyColumns out) const {
  copy_columns(start_.columns(), out);
  for (std::size_t n = 0; n < trial().bodies.size(); ++n) {
    const RecordedBody& body = trial().bodies[n];
    const auto i = static_cast<std::size_t>(body.body);
    const auto [from, s, h] = interval_of(body, t);
    if (!body.positions.empty()) {
      const Vec3 &a = body.positions[from], &b = body.positions[from + 1];
      const Vec3 u = h * velocities_[n][from], v = h * velocities_[n][from + 1];
      const double r = 1 - s;
      out.set_position(i, r * r * ((1 + 2 * s) * a + s * u) + s * s * ((1 + 2 * r) * b - r * v));
      out.set_velocity(i, (6 * s * r * (b - a) + r * (1 - 3 * s) * u + s * (3 * s - 2) * v) / h);
    }
    if (!body.orientations.empty()) {
      const Quat &a = body.orientations[from], &b = body.orientations[from + 1];
      out.set_orientation(i, (rotation_by(s * rotation_vector_of(b * a.conjugate())) * a).normalized());
      out.set_angular_velocity(i, (1 - s) * angular_velocities_[n][from] + s * angular_velocities_[n][from + 1]);
    }
  }
}

double RecordedMotion::error(double t) const {
  const MotionRecording& of = *recording_;
  double most = 0;
  for (std::size_t n = 0; n < trial().bodies.size(); ++n) {
    const RecordedBody& body = trial().bodies[n];
    const auto [from, s, h] = interval_of(body, t);
    if (t > body.times.back() + kTimeRounding * h) return std::numeric_limits<double>::infinity();
    most = std::max(most, s > 0 ? errors_[n][from] : from > 0 ? errors_[n][from - 1] : 0);
  }
  return std::max(of.position_noise, of.orientation_noise) + most;
}

bool RecordedMotion::is_measured(const RecordedBody& body, double t) const {
  const auto n = static_cast<std::size_t>(&body - trial().bodies.data());
  const auto [from, s, h] = interval_of(body, t);
  if (t < 0 || t > body.times.back() + kTimeRounding * h) return false;
  return h <= longest_interval_[n] || s <= kTimeRounding || s >= 1 - kTimeRounding;
}

std::string RecordedMotion::caveat() const {
  const MotionRecording& of = *recording_;
  std::string text =
      of.synthetic.empty() ? "" : fmt::format("The recording is synthetic: '{}' made it. ", of.synthetic);
  if (of.trials.size() > 1) {
    double shortest = of.longest();
    for (const RecordedTrial& trial : of.trials) shortest = std::min(shortest, trial.duration);
    text += fmt::format("The {} trials last {:.3g} to {:.3g} s, and each run ends with its trial. ", of.trials.size(),
                        shortest, of.longest());
  }
  const double degrees = of.orientation_noise * 180 / M_PI;
  text += fmt::format(
      "The measurement has a noise of {:.2g} m and {:.2g}°, which alone makes mean errors of {:.2g} m and {:.2g}°.",
      of.position_noise, degrees, kMeanOfNoise * of.position_noise, kMeanOfNoise * degrees);
  if (of.is_noise_estimated) text += " It is estimated from the scatter of the samples, which shows no constant error.";
  return text;
}

const RecordedMotion* as_recording(const Truth* truth) { return dynamic_cast<const RecordedMotion*>(truth); }

std::unique_ptr<Truth> truth_of(const Case& definition, double duration) {
  if (definition.truth != "recording") return make_truth(definition.truth, definition.scene, duration);
  const auto recording = definition.recording;
  if (!recording) throw InputError(missing_recording(definition));
  check_covers(*recording, duration, definition.id);
  return std::make_unique<RecordedMotion>(recording, 0, definition.scene);
}

Case case_of_trial(const Case& definition, const MotionRecording& recording, std::size_t trial) {
  Case one = definition;
  const double rounding = 1 + 1e-6;  // of times written with seven digits
  one.duration = std::min(definition.duration, recording.trials.at(trial).duration * rounding);
  start_from(recording, trial, one.scene);
  return one;
}

TruthRow recording_truth() {
  return {"recording", "measured motion from a CSV or MCAP file, with its noise",
          [](const Scene&, double) -> std::unique_ptr<Truth> {
            throw InputError("the truth 'recording' belongs to a case file, which names its file");
          }};
}

Provenance recording_provenance() {
  return {"recording", "measured motion, independent of every engine and method unless it is synthetic"};
}

}  // namespace rigor::inline truth
