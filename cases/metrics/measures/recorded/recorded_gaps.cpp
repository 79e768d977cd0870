#include "cases/metrics/measures/recorded/recorded_gaps.h"

#include <fmt/format.h>

#include <algorithm>

#include "cases/metrics/measures/measuring.h"

namespace rigor::inline metric {

std::vector<RecordedGap> recorded_gaps(const Trajectory& trajectory, const RecordedMotion& truth, RecordedPart part) {
  std::vector<RecordedGap> gaps;
  if (trajectory.samples.empty()) return gaps;
  BodyTable expected(trajectory.samples.front().bodies.size());
  for (std::size_t n = 1; n < trajectory.samples.size(); ++n) {
    const Sample& sample = trajectory.samples[n];
    truth.at(sample.time, expected.columns());
    const BodyColumns run = sample.bodies.columns(), recorded = expected.columns();
    for (const RecordedBody& body : truth.trial().bodies) {
      const auto i = static_cast<std::size_t>(body.body);
      const bool has_part = part == RecordedPart::position ? !body.positions.empty() : !body.orientations.empty();
      if (!has_part || !truth.is_measured(body, sample.time)) continue;
      gaps.push_back({sample.time, body.body,
                      part == RecordedPart::position ? (run.position(i) - recorded.position(i)).norm()
                                                     : angle_between(run.orientation(i), recorded.orientation(i))});
    }
  }
  return gaps;
}

bool reaches_the_end(const Trajectory& trajectory, const RecordedMotion& truth, double duration) {
  const auto& samples = trajectory.samples;
  if (samples.size() < 2) return false;
  const double between = samples[1].time - samples[0].time;
  return samples.back().time + 1.001 * between >= std::min(duration, truth.trial().duration);
}

std::string why_no_recording(const JudgedRun& run) {
  return run.truth && as_recording(run.truth->source) ? "" : "the truth is no recording";
}

MetricResult mean_gap(const JudgedRun& run, RecordedPart part, double scale) {
  const bool is_position = part == RecordedPart::position;
  const RecordedMotion& truth = *as_recording(run.truth->source);
  if (!reaches_the_end(run.trajectory, truth, run.duration))
    return {{}, "the run ended before the recording, so its mean would leave out the worst"};
  const std::vector<RecordedGap> gaps = recorded_gaps(run.trajectory, truth, part);
  if (gaps.empty())
    return {{},
            is_position ? "no sample of the run lies between recorded positions"
                        : "no sample of the run lies between recorded orientations"};
  TimeSeries series;
  double sum = 0;
  for (std::size_t first = 0, last = 0; first < gaps.size(); first = last) {
    double of_sample = 0;
    RecordedGap worst;
    for (last = first; last < gaps.size() && gaps[last].time == gaps[first].time; ++last) {
      of_sample += gaps[last].gap;
      if (gaps[last].gap >= worst.gap) worst = gaps[last];
    }
    sum += of_sample;
    const double found = scale * worst.gap;
    series.add(scale * of_sample / static_cast<double>(last - first),
               {worst.time, worst.body, is_position ? "position" : "orientation", found, 0});
  }
  Measurement measured = std::move(series).finish();
  const MotionRecording& of = truth.recording();
  const double noise = kMeanOfNoise * (is_position ? of.position_noise : of.orientation_noise);
  measured.value = scale * std::max(noise, sum / static_cast<double>(gaps.size()));
  return {std::move(measured), ""};
}

}  // namespace rigor::inline metric
