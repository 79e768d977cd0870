// Layout, little-endian, then zlib, then base64:
//   u8 1 if the motion is the truth's; f64 seconds between samples; f64 time of the last; u32 bodies;
//   u32 keys (0: no motion here), their samples; f32 lowest x y z, f32 extent x y z; for each of x, y, z and the
//   quaternion's x, y, z (its w >= 0), for each body, for each key: u16, over the extent or over -1..1;
//   u32 points, their samples; u8 series, u8 its name's number for each; for each series and point: u16, the upper
//   half of a float32, not a number where the series has ended.
// All u16 stand as Bytes::add_differences; samples are two such lists, the lower and the upper halves of u32.
#include "cases/report/html/playback.h"

#include <algorithm>
#include <cmath>

#include "cases/metrics/measures/energy_series.h"
#include "cases/report/html/motion.h"
#include "cases/report/json/packing.h"
#include "cases/report/html/thinning.h"
#include "core/dynamics/model/energy.h"

namespace rigor {
namespace {

constexpr double kLinearSeen = 5e-3;       // of a series' range: a pixel of a plot
constexpr double kDecadesSeen = 0.04;      // of a logarithmic plot: likewise
constexpr double kNoise = 1e-12;           // of a series in any unit: smaller values are rounding without shape
constexpr std::size_t kMostKeys = 6000;    // of a motion
constexpr std::size_t kMostPoints = 1500;  // of the series
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

void add_samples(Bytes& bytes, const std::vector<std::size_t>& samples) {
  std::vector<std::uint16_t> low, high;
  for (const std::size_t n : samples) {
    low.push_back(static_cast<std::uint16_t>(n)), high.push_back(static_cast<std::uint16_t>(n >> 16));
  }
  bytes.add_u32(static_cast<std::uint32_t>(samples.size()));
  bytes.add_differences(low), bytes.add_differences(high);
}

std::uint16_t quantised(double share) {
  return static_cast<std::uint16_t>(std::lround(65535 * std::clamp(share, 0.0, 1.0)));
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

// The series of one run, for thinning: all at the same samples.
class SeriesSet {
 public:
  explicit SeriesSet(std::vector<NamedSeries> all) : series_(std::move(all)) {
    for (const NamedSeries& series : series_) {
      double largest = kNoise;
      for (const double value : series.values) {
        if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
      }
      const double floor = std::max(kNoise, 1e-6 * largest);
      Seen& seen = seen_.emplace_back();
      for (const double value : series.values) {
        seen.linear.push_back(value / (largest * kLinearSeen));
        seen.decades.push_back(std::log10(std::max(std::abs(value), floor)) / kDecadesSeen);
      }
      count_ = std::max(count_, series.values.size());
    }
  }

  std::size_t count() const { return count_; }

  // Series by series, because each is contiguous.
  KeptSample worst_between(std::size_t a, std::size_t b) const {
    std::vector<double> shares(b - a - 1), off(b - a - 1, 0.0);  // of the samples from a + 1 on
    for (std::size_t k = 0; k < shares.size(); ++k) shares[k] = static_cast<double>(k + 1) / static_cast<double>(b - a);
    for (const Seen& seen : seen_) {
      const std::size_t length = seen.linear.size();
      if (b < length) {
        raise_to_deviations(seen.linear, a, b, shares, off), raise_to_deviations(seen.decades, a, b, shares, off);
      } else if (length >= a + 2) {  // it ends in this stretch, and its end is kept
        off[length - a - 2] = std::numeric_limits<double>::max();
      }
    }
    KeptSample worst{a, 0};
    for (std::size_t k = 0; k < off.size(); ++k) {
      if (off[k] > worst.deviation) worst = {a + 1 + k, off[k]};
    }
    return worst;
  }

  void add_to(Bytes& bytes, const std::vector<std::size_t>& points) const {
    add_samples(bytes, points);
    bytes.add_u8(static_cast<std::uint8_t>(series_.size()));
    for (const NamedSeries& series : series_) {
      const auto& names = series_names();
      bytes.add_u8(static_cast<std::uint8_t>(std::find(names.begin(), names.end(), series.name) - names.begin()));
    }
    std::vector<std::uint16_t> values;
    for (const NamedSeries& series : series_) {
      for (const std::size_t n : points)
        values.push_back(half_of_float(n < series.values.size() ? series.values[n] : NAN));
    }
    bytes.add_differences(values);
  }

 private:
  static void raise_to_deviations(const std::vector<double>& values, std::size_t a, std::size_t b,
                                  const std::vector<double>& shares, std::vector<double>& off) {
    const double first = values[a], last = values[b];
    const double* between = &values[a] + 1;
    for (std::size_t k = 0; k < off.size(); ++k)
      off[k] = std::max(off[k], std::abs(between[k] - (1 - shares[k]) * first - shares[k] * last));
  }

  // A series on the two scales of a plot, in units of the smallest visible difference.
  struct Seen {
    std::vector<double> linear, decades;
  };
  std::vector<NamedSeries> series_;
  std::vector<Seen> seen_;
  std::size_t count_ = 0;
};

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
        is_like_truth_(motion_.is_like_truth()),
        bodies_(scene.bodies.size()) {
    if (!is_like_truth_) candidates_ = motion_.candidates();
    const Poses poses(motion_, candidates_);
    keys_ = ranked_samples(candidates_.size(), kMostKeys,
                           [&](std::size_t n, std::size_t a, std::size_t b) { return poses.deviation(n, a, b); });
    std::vector<NamedSeries> main;
    std::copy_if(named.begin(), named.end(), std::back_inserter(main), is_main);
    all_ = ranked(std::move(named)), main_ = ranked(std::move(main));
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
    add(all_, 1);
    for (double share = 1; share * std::max(keys_.size(), main_.points.size()) >= 1;) {
      share *= std::min(kCoarser, add(main_, share));
      if (!found.empty() && found.back().size() <= kLeast) break;
    }
    return found;
  }

 private:
  struct Ranked {
    SeriesSet series{{}};
    std::vector<KeptSample> points;
  };

  static Ranked ranked(std::vector<NamedSeries> named) {
    Ranked out{SeriesSet(std::move(named)), {}};
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
  bool is_like_truth_;
  std::size_t bodies_;
  std::vector<std::size_t> candidates_;
  std::vector<KeptSample> keys_;
  Ranked all_, main_;
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

const Packings& packings_in(const Recordings& recordings) {
  static const Packings none;
  const auto found = recordings.find(PlaybackRecorder::kName);
  return found == recordings.end() ? none : found->second;
}

const std::string& finest_within(const Packings& packings, double size) {
  static const std::string none;
  for (const std::string& text : packings) {
    if (static_cast<double>(text.size()) <= size) return text;
  }
  return none;
}

}  // namespace

const std::vector<std::string>& series_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {kEnergyChange};
    for (const MetricRow& row : metrics()) all.push_back(row.name);
    return all;
  }();
  return names;
}

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
  return static_cast<std::size_t>(std::min(kEvenShares * even, static_cast<double>(kMost)));
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
    scale_ = scale;
    std::size_t sum = 0;
    for (const CaseResult& result : results.cases) {
      sum += of_truth(result).size();
      for (const Cell& cell : result.cells) sum += of(result, cell).size();
    }
    return sum;
  };
  double fits = 0, too_much = 2.0 * kMost;  // of the latter each is at its finest
  if (total(too_much) <= budget) return;
  for (int halving = 0; halving < 50; ++halving) {
    const double middle = 0.5 * (fits + too_much);
    (total(middle) <= budget ? fits : too_much) = middle;
  }
  scale_ = fits;
}

const std::string& PlaybackChoice::of(const CaseResult& result, const Cell& cell) const {
  return finest_within(packings_in(cell.recordings), scale_ * weight_of(result.definition, cell.dt.seconds));
}

const std::string& PlaybackChoice::of_truth(const CaseResult& result) const {
  static const Recordings none;
  return finest_within(packings_in(result.truth ? result.truth->recordings : none),
                       scale_ * weight_of(result.definition, kTruth));
}

}  // namespace rigor
