// A run's motion for the page: until it leaves the picture, at the resolution that an eye can distinguish.
#pragma once

#include <limits>
#include <vector>

#include "cases/metrics/metric.h"

namespace rigor::inline report {

struct BoundingBox {
  Vec3 low = Vec3::Constant(std::numeric_limits<double>::infinity()), high = -low;
  void add(const Vec3& point) { low = low.cwiseMin(point), high = high.cwiseMax(point); }
  void add(BodyColumns bodies) {
    for (std::size_t i = 0; i < bodies.size(); ++i) add(bodies.position(i));
  }
  double size() const { return low.x() <= high.x() ? (high - low).norm() : 0; }
};

class Motion {
 public:
  // `truth` may be null. All three must live on.
  Motion(const Scene& scene, const Trajectory& trajectory, const TruthSamples* truth);

  std::size_t count() const { return count_; }  // of the first samples, all within the picture
  const BoundingBox& bounds() const { return bounds_; }
  double position_seen() const { return position_seen_; }  // m
  BodyColumns bodies(std::size_t n) const { return samples_[n].bodies.columns(); }

  // Whether the truth would make the same picture at every sample.
  bool is_like_truth() const;

  // The samples to look at: of each stretch the one at which a velocity jumps most, so that no impact is lost.
  std::vector<std::size_t> candidates() const;

 private:
  double difference(BodyColumns a, BodyColumns b) const;  // 1 is seen
  double jump_at(std::size_t n) const;                    // m/s

  const Scene& scene_;
  const std::vector<Sample>& samples_;
  const TruthSamples* truth_;
  std::size_t count_;
  BoundingBox bounds_;
  double smallest_ = 1e-6;  // m, the largest bounding radius of a body; no scene is smaller
  double position_seen_ = 0;
};

// The poses at some samples, close together in memory and with unit quaternions: thinning looks at each many times.
class Poses {
 public:
  Poses(const Motion& motion, const std::vector<std::size_t>& samples);

  // The visible deviation of the n-th pose from the interpolation between the a-th and b-th; 1 is visible.
  double deviation(std::size_t n, std::size_t a, std::size_t b) const;

 private:
  const std::vector<std::size_t>& samples_;
  double position_seen_;
  std::vector<Vec3> positions_;
  std::vector<Eigen::Vector4d> turns_;
  std::size_t bodies_ = 0;
};

}  // namespace rigor::inline report
