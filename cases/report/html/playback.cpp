// Layout, little-endian, then zlib, then base64:
//   u8 1 if the motion is the truth's; f64 seconds between samples; f64 time of the last; u32 bodies;
//   u32 keys (0: no motion here), their samples; f32 lowest x y z, f32 extent x y z; for each of x, y, z and the
//   quaternion's x, y, z (its w >= 0), for each body, for each key: u16, over the extent or over -1..1;
//   u32 points, their samples; u8 courses, u8 its name's number for each; for each course and point: u16, the upper
//   half of a float32, not a number where the course has ended.
// All u16 stand as Bytes::add_differences; samples are two such lists, the lower and the upper halves of u32.
#include "cases/report/html/playback.h"

#include <algorithm>
#include <cmath>

#include "cases/report/html/motion.h"
#include "cases/report/html/packing.h"
#include "cases/report/html/thinning.h"
#include "core/dynamics/energy.h"

namespace rigor {
namespace {

constexpr double kLinearSeen = 5e-3;       // of a course's range: a pixel of a plot
constexpr double kDecadesSeen = 0.04;      // of a logarithmic plot: likewise
constexpr double kNoise = 1e-12;           // of a course in any unit: what is smaller is rounding, and has no shape
constexpr std::size_t kMostKeys = 6000;    // of a motion
constexpr std::size_t kMostPoints = 1500;  // of the courses

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

// The courses of one run, for thinning: all at the same samples.
class Courses {
 public:
  explicit Courses(std::vector<NamedCourse> courses) : courses_(std::move(courses)) {
    for (const NamedCourse& course : courses_) {
      double largest = kNoise;
      for (const double value : course.values) {
        if (std::isfinite(value)) largest = std::max(largest, std::abs(value));
      }
      const double floor = std::max(kNoise, 1e-6 * largest);
      Seen& seen = seen_.emplace_back();
      for (const double value : course.values) {
        seen.linear.push_back(value / (largest * kLinearSeen));
        seen.decades.push_back(std::log10(std::max(std::abs(value), floor)) / kDecadesSeen);
      }
      count_ = std::max(count_, course.values.size());
    }
  }

  std::size_t count() const { return count_; }

  double deviation(std::size_t n, std::size_t a, std::size_t b) const {
    const double share = static_cast<double>(n - a) / static_cast<double>(b - a);
    double worst = 0;
    for (const Seen& seen : seen_) {
      const std::size_t length = seen.linear.size();
      if (n >= length) continue;
      if (b >= length) {  // it ends in this stretch, and its end is kept
        if (n + 1 == length) return std::numeric_limits<double>::max();
        continue;
      }
      const auto off = [&](const std::vector<double>& values) {
        return std::abs(values[n] - (1 - share) * values[a] - share * values[b]);
      };
      worst = std::max({worst, off(seen.linear), off(seen.decades)});
    }
    return worst;
  }

  void add_to(Bytes& bytes, const std::vector<std::size_t>& points) const {
    add_samples(bytes, points);
    bytes.add_u8(static_cast<std::uint8_t>(courses_.size()));
    for (const NamedCourse& course : courses_) {
      const auto& names = course_names();
      bytes.add_u8(static_cast<std::uint8_t>(std::find(names.begin(), names.end(), course.name) - names.begin()));
    }
    std::vector<std::uint16_t> values;
    for (const NamedCourse& course : courses_) {
      for (const std::size_t n : points)
        values.push_back(half_of_float(n < course.values.size() ? course.values[n] : NAN));
    }
    bytes.add_differences(values);
  }

 private:
  // A course on the two scales of a plot, in what can just be seen there.
  struct Seen {
    std::vector<double> linear, decades;
  };
  std::vector<NamedCourse> courses_;
  std::vector<Seen> seen_;
  std::size_t count_ = 0;
};

NamedCourse energy_change(const Scene& scene, const Trajectory& trajectory, double scale) {
  NamedCourse course{kEnergyChange, {}};
  for (const Sample& sample : trajectory.samples) course.values.push_back(energy(scene, sample.bodies.columns()));
  for (std::size_t n = course.values.size(); n-- > 0;) course.values[n] -= course.values.front();
  for (double& value : course.values) value /= scale > 0 ? scale : 1;
  return course;
}

std::string packed(const Scene& scene, const Trajectory& trajectory, const TruthSamples* truth,
                   std::vector<NamedCourse> named, std::size_t budget) {
  if (trajectory.samples.empty()) return "";
  const Motion motion(scene, trajectory, truth);
  const Courses courses(std::move(named));
  const bool is_like_truth = motion.is_like_truth();
  const std::vector<std::size_t> candidates = is_like_truth ? std::vector<std::size_t>() : motion.candidates();
  const Poses poses(motion, candidates);
  const auto keys = ranked_samples(candidates.size(), kMostKeys, [&](std::size_t n, std::size_t a, std::size_t b) {
    return poses.deviation(n, a, b);
  });
  const auto points = ranked_samples(courses.count(), kMostPoints, [&](std::size_t n, std::size_t a, std::size_t b) {
    return courses.deviation(n, a, b);
  });
  double share = 1;
  for (int attempt = 0; attempt < 6; ++attempt) {
    Bytes bytes;
    bytes.add_u8(is_like_truth);
    bytes.add_f64(trajectory.samples.size() > 1 ? trajectory.samples[1].time - trajectory.samples[0].time : 0);
    bytes.add_f64(trajectory.samples.back().time);
    bytes.add_u32(static_cast<std::uint32_t>(scene.bodies.size()));
    std::vector<std::size_t> kept = first_samples(keys, static_cast<std::size_t>(std::ceil(share * keys.size())));
    for (std::size_t& n : kept) n = candidates[n];
    constexpr std::size_t kFewest = 6;  // fewer show no motion
    if (kept.size() < kFewest && keys.size() > kept.size()) kept.clear();
    add_motion(bytes, motion, kept);
    courses.add_to(bytes, first_samples(points, static_cast<std::size_t>(std::ceil(share * points.size()))));
    const std::string text = base64(deflated(bytes.data()));
    if (text.size() <= budget) return text;
    share *= 0.9 * static_cast<double>(budget) / static_cast<double>(text.size());
  }
  return "";
}

}  // namespace

const std::vector<std::string>& course_names() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all = {kEnergyChange};
    for (const MetricRow& row : metrics()) all.push_back(row.name);
    return all;
  }();
  return names;
}

std::string packed_run(const JudgedRun& run, const std::vector<NamedCourse>& courses, double largest_kinetic_energy,
                       std::size_t budget) {
  std::vector<NamedCourse> all = {energy_change(run.scene, run.trajectory, largest_kinetic_energy)};
  for (const NamedCourse& course : courses) {
    if (!course.values.empty()) all.push_back(course);
  }
  return packed(run.scene, run.trajectory, run.truth, std::move(all), budget);
}

std::string packed_truth(const Scene& scene, const Truth& truth, double duration, double largest_kinetic_energy,
                         std::size_t budget) {
  constexpr int kSamples = 1500;
  Trajectory trajectory{.dt = duration / kSamples, .samples = {}};
  for (int n = 0; n <= kSamples; ++n) {
    trajectory.samples.push_back({duration * n / kSamples, BodyTable(scene.bodies.size())});
    truth.at(trajectory.samples.back().time, trajectory.samples.back().bodies.columns());
  }
  return packed(scene, trajectory, nullptr, {energy_change(scene, trajectory, largest_kinetic_energy)}, budget);
}

std::size_t playback_budget(const Results& grid, const CaseResult& result, const StepSize* dt) {
  constexpr double kWholePage = 5.2e6, kMost = 300e3;  // characters
  // The coarsest step is the one that is looked at; more bodies take more room, but each of them less.
  const auto weight = [](const CaseResult& one, double seconds) {
    double coarsest = 0;
    for (const StepSize& step : one.definition.dt) coarsest = std::max(coarsest, step.seconds);
    return std::pow(static_cast<double>(one.definition.scene.bodies.size()), 0.75) * (seconds < coarsest ? 1 : 2);
  };
  constexpr double kTruth = std::numeric_limits<double>::infinity();
  double sum = 0;
  for (const CaseResult& one : grid.cases) {
    sum += weight(one, kTruth);
    for (const Cell& cell : one.cells) {
      if (cell.status != Status::unsupported) sum += weight(one, cell.dt.seconds);
    }
  }
  const double own = weight(result, dt ? dt->seconds : kTruth);
  return static_cast<std::size_t>(std::min(kWholePage * own / sum, kMost));
}

}  // namespace rigor
