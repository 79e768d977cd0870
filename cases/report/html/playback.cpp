// Layout, little-endian, then zlib, then base64:
//   u8 1 if the motion is the truth's; f64 seconds between samples; f64 time of the last; u32 bodies;
//   u32 keys (0: no motion here), their samples; f32 lowest x y z, f32 extent x y z; for each of x, y, z and the
//   quaternion's x, y, z (its w >= 0), for each body, for each key: u16, over the extent or over -1..1;
//   u32 points, their samples; u8 series, u8 its name's number for each; for each series and point: u16, the upper
//   half of a float32, not a number where the series has ended; then the contact forces at these points
//   (force_playback.h).
// All u16 stand as Bytes::add_differences; samples are two such lists, the lower and the upper halves of u32.
#include "cases/report/html/playback.h"

#include <algorithm>
#include <cmath>

#include "cases/case/recording/recording.h"
#include "cases/metrics/measures/energy_series.h"
#include "cases/report/html/motion.h"
#include "cases/report/html/packed_series.h"
#include "cases/report/html/thinning.h"
#include "cases/results/trial_results.h"
#include "core/dynamics/model/energy.h"

namespace rigor::inline report {
namespace {

constexpr std::size_t kMostKeys = 6000;              // of a motion
constexpr std::size_t kMostPoints = 1500;            // of the series
constexpr std::size_t kMost = 300000, kLeast = 200;  // characters of a packing
constexpr double kOfAllRuns = 6e6, kEvenShares = 6;  // characters; a number of even shares that a run may request
constexpr double kCoarser = 0.7;                     // of the keys and points, from one packing to the next

// The series that the page always plots.
bool is_main(const NamedSeries& series) {
  constexpr const char* kMain[] = {kEnergyChange,   "angular_momentum_drift", "energy_drift_synchronised",
                                   "joint_gap",     "linear_momentum_drift",  "orientation_error",
                                   "position_error"};
  return std::find(std::begin(kMain), std::end(kMain), series.name) != std::end(kMain);
}

void add_motion(Bytes& bytes, const Motion& motion, const std::vector<std::size_t>& keys) {
  add_samples(bytes, keys);
  if (keys.empty()) return;
  const Vec3 low = motion.bounds().low, extent = motion.bounds().high - low;
  for (int axis = 0; axis < 3; ++axis) bytes.add_f32(static_cast<float>(low[axis]));
  for (int axis = 0; axis < 3; ++axis) bytes.add_f32(static_cast<float>(extent[axis]));
  std::vector<std::uint16_t> values;
  const std::size_t count = motion.bodies(0).size();
  for (int channel = 0; channel < 6; ++channel) {
    for (std::size_t i = 0; i < count; ++i) {
      for (const std::size_t n : keys) {
        if (channel < 3) {
          const double from_low = motion.bodies(n).position(i)[channel] - low[channel];
          values.push_back(quantised(extent[channel] > 0 ? from_low / extent[channel] : 0));
        } else {
          const Quat q = motion.bodies(n).orientation(i).normalized();
          values.push_back(quantised(0.5 + 0.5 * (q.w() < 0 ? -1 : 1) * q.vec()[channel - 3]));
        }
      }
    }
  }
  bytes.add_differences(values);
}

NamedSeries energy_change(std::vector<double> energies, double scale) {
  NamedSeries series{kEnergyChange, std::move(energies)};
  for (std::size_t n = series.values.size(); n-- > 0;) series.values[n] -= series.values.front();
  for (double& value : series.values) value /= scale > 0 ? scale : 1;
  return series;
}

// The motion of one run and its series, ranked once and packed at any fineness.
class Packer {
 public:
  Packer(const Scene& scene, const Trajectory& trajectory, const TruthSamples* truth, std::vector<NamedSeries> named)
      : trajectory_(trajectory),
        motion_(scene, trajectory, truth),
        forces_(trajectory),
        is_like_truth_(motion_.is_like_truth()),
        bodies_(scene.bodies.size()) {
    if (!is_like_truth_) candidates_ = motion_.candidates();
    const Poses poses(motion_, candidates_);
    keys_ = ranked_samples(candidates_.size(), kMostKeys,
                           [&](std::size_t n, std::size_t a, std::size_t b) { return poses.deviation(n, a, b); });
    std::vector<NamedSeries> main;
    std::copy_if(named.begin(), named.end(), std::back_inserter(main), is_main);
    ranked_.push_back(ranked(std::move(named))), ranked_.push_back(ranked(std::move(main)));
  }

  Packings packings(std::size_t limit) const {
    Packings found;
    // Returns which share of it would fit.
    const auto add = [&](const Ranked& ranked, double share) {
      std::string text = packed(ranked, share);
      const double fits = std::min(1.0, static_cast<double>(limit) / static_cast<double>(text.size()));
      const bool is_shorter = found.empty() || text.size() < found.back().size();
      if (fits == 1 && is_shorter) found.push_back(std::move(text));
      return fits;
    };
    add(ranked_[0], 1);
    for (double share = 1; share * std::max(keys_.size(), ranked_[1].points.size()) >= 1;) {
      share *= std::min(kCoarser, add(ranked_[1], share));
      if (!found.empty() && found.back().size() <= kLeast) break;
    }
    return found;
  }

 private:
  struct Ranked {
    SeriesSet series;
    std::vector<KeptSample> points;
  };

  Ranked ranked(std::vector<NamedSeries> named) const {
    Ranked out{SeriesSet(std::move(named), forces_), {}};
    out.points = ranked_samples(out.series.count(), kMostPoints, [&](std::size_t first, std::size_t last) {
      return out.series.worst_between(first, last);
    });
    return out;
  }

  std::string packed(const Ranked& ranked, double share) const {
    const auto part = [&](const std::vector<KeptSample>& samples) {
      return first_samples(samples, static_cast<std::size_t>(std::ceil(share * samples.size())));
    };
    const auto& samples = trajectory_.samples;
    Bytes bytes;
    bytes.add_u8(is_like_truth_);
    bytes.add_f64(samples.size() > 1 ? samples[1].time - samples[0].time : 0);
    bytes.add_f64(samples.back().time);
    bytes.add_u32(static_cast<std::uint32_t>(bodies_));
    std::vector<std::size_t> kept = part(keys_);
    for (std::size_t& n : kept) n = candidates_[n];
    constexpr std::size_t kFewest = 6;  // fewer show no motion
    if (kept.size() < kFewest && keys_.size() > kept.size()) kept.clear();
    add_motion(bytes, motion_, kept);
    ranked.series.add_to(bytes, part(ranked.points));
    return base64(deflated(bytes.data()));
  }

  const Trajectory& trajectory_;
  Motion motion_;
  ForcePlayback forces_;
  bool is_like_truth_;
  std::size_t bodies_;
  std::vector<std::size_t> candidates_;
  std::vector<KeptSample> keys_;
  std::vector<Ranked> ranked_;  // all series, then the main ones
};

Packings packed(const Scene& scene, const Trajectory& trajectory, const TruthSamples* truth,
                std::vector<NamedSeries> named, std::size_t limit) {
  if (trajectory.samples.empty()) return {};
  return Packer(scene, trajectory, truth, std::move(named)).packings(limit);
}

// The coarsest step is usually viewed, and the truth beside each run. More bodies take more room, but each body less.
double weight_of(const Case& definition, double seconds) {
  double coarsest = 0;
  for (const StepSize& step : definition.dt) coarsest = std::max(coarsest, step.seconds);
  return std::pow(static_cast<double>(definition.scene.bodies.size()), 0.75) * (seconds < coarsest ? 1 : 4);
}
constexpr double kTruth = std::numeric_limits<double>::infinity();  // stands for its dt

std::size_t trials_in(const Case& definition) {
  return definition.recording ? std::max<std::size_t>(1, definition.recording->trials.size()) : 1;
}

const std::string& finest_within(const Packings& packings, double size) {
  static const std::string none;
  for (const std::string& text : packings) {
    if (static_cast<double>(text.size()) <= size) return text;
  }
  return none;
}

// Calls visit(motion) for each trial in order, with the finest packing within its share of `size`.
template <typename Visit>
void for_each_trial(const Case& definition, const Recordings& recordings, double size, const Visit& visit) {
  const std::size_t trials = trials_in(definition);
  static const Packings none;
  for (std::size_t k = 0; k < trials; ++k) {
    const auto found = recordings.find(recording_of_trial(PlaybackRecorder::kName, k));
    visit(finest_within(found == recordings.end() ? none : found->second, size / static_cast<double>(trials)));
  }
}

const Recordings& recordings_of_truth(const CaseResult& result) {
  static const Recordings none;
  return result.truth ? result.truth->recordings : none;
}

}  // namespace

Packings packed_run(const JudgedRun& run, const std::vector<NamedSeries>& series, double largest_kinetic_energy,
                    std::size_t limit) {
  std::vector<NamedSeries> all = {energy_change(energies_of(run, 0).least, largest_kinetic_energy)};
  for (const NamedSeries& one : series) {
    if (!one.values.empty()) all.push_back(one);
  }
  return packed(run.scene, run.trajectory, run.truth, std::move(all), limit);
}

Packings packed_truth(const Scene& scene, const Truth& truth, double duration, double largest_kinetic_energy,
                      std::size_t limit) {
  constexpr int kSamples = 1500;
  Trajectory trajectory{.dt = duration / kSamples, .samples = {}};
  std::vector<double> energies;
  for (int n = 0; n <= kSamples; ++n) {
    trajectory.samples.push_back({duration * n / kSamples, KeptBodies(scene.bodies.size())});
    truth.at(trajectory.samples.back().time, trajectory.samples.back().bodies.columns());
    energies.push_back(energy(scene, trajectory.samples.back().bodies.columns()));
  }
  return packed(scene, trajectory, nullptr, {energy_change(std::move(energies), largest_kinetic_energy)}, limit);
}

PlaybackLimit::PlaybackLimit(const Results& grid) {
  for (const CaseResult& one : grid.cases) {
    weights_ += weight_of(one.definition, kTruth);
    for (const Cell& cell : one.cells) {
      if (cell.status != Status::unsupported) weights_ += weight_of(one.definition, cell.dt.seconds);
    }
  }
}

std::size_t PlaybackLimit::of(const Case& definition, const StepSize* dt) const {
  const double even = kOfAllRuns * weight_of(definition, dt ? dt->seconds : kTruth) / weights_;
  const double of_all_trials = std::min(kEvenShares * even, static_cast<double>(kMost));
  return static_cast<std::size_t>(of_all_trials / static_cast<double>(trials_in(definition)));
}

Recording PlaybackRecorder::of_truth(const Case& definition, const Truth& truth, const TruthFacts& facts) const {
  return packed_truth(definition.scene, truth, definition.duration, facts.largest_kinetic_energy,
                      limit_.of(definition, nullptr));
}

Recording PlaybackRecorder::of_run(const Case& definition, const Cell& cell, const JudgedRun& run,
                                   const std::vector<NamedSeries>& series, const TruthFacts& facts) const {
  return packed_run(run, series, facts.largest_kinetic_energy, limit_.of(definition, &cell.dt));
}

PlaybackChoice::PlaybackChoice(const Results& results, std::size_t budget) {
  const auto total = [&](double scale) {
    std::size_t sum = 0;
    const auto add = [&](const CaseResult& result, const Recordings& recordings, double seconds) {
      for_each_trial(result.definition, recordings, scale * weight_of(result.definition, seconds),
                     [&](const std::string& motion) { sum += motion.size(); });
    };
    for (const CaseResult& result : results.cases) {
      add(result, recordings_of_truth(result), kTruth);
      for (const Cell& cell : result.cells) add(result, cell.recordings, cell.dt.seconds);
    }
    return sum;
  };
  scale_ = 2.0 * kMost;  // each is at its finest
  if (total(scale_) <= budget) return;
  double fits = 0, too_much = scale_;
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = 0.5 * (fits + too_much);
    (total(middle) <= budget ? fits : too_much) = middle;
  }
  scale_ = fits;
}

Motions PlaybackChoice::chosen(const CaseResult& result, const Recordings& recordings, double seconds) const {
  Motions motions;
  for_each_trial(result.definition, recordings, scale_ * weight_of(result.definition, seconds),
                 [&](const std::string& motion) { motions.push_back(motion); });
  return motions;
}

Motions PlaybackChoice::of(const CaseResult& result, const Cell& cell) const {
  return chosen(result, cell.recordings, cell.dt.seconds);
}

Motions PlaybackChoice::of_truth(const CaseResult& result) const {
  return chosen(result, recordings_of_truth(result), kTruth);
}

}  // namespace rigor::inline report
