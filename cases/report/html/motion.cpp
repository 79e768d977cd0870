#include "cases/report/html/motion.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline report {
namespace {

constexpr double kPositionSeen = 1e-3;  // of the motion's extent: a pixel or so of the picture
constexpr double kTurnSeen = 0.01;      // rad
constexpr double kFarthest = 20;        // times the extent of the truth: a run beyond has left the picture
constexpr double kMostPoses = 1e5;      // looked at when thinning, bodies times samples: some 50 ms

double bounding_radius_of(const Body& body) {
  if (!body.shape) return 0.1;
  return std::holds_alternative<Plane>(*body.shape) ? 0 : bounding_radius(*body.shape);
}

bool is_within(BodyColumns bodies, const Vec3& centre, double farthest) {
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!((bodies.position(i) - centre).norm() <= farthest)) return false;
  }
  return true;
}

}  // namespace

Motion::Motion(const Scene& scene, const Trajectory& trajectory, const TruthSamples* truth)
    : scene_(scene), samples_(trajectory.samples), truth_(truth), count_(samples_.size()) {
  BoundingBox expected;
  for (const Body& body : scene.bodies)
    expected.add(body.position), smallest_ = std::max(smallest_, bounding_radius_of(body));
  const Vec3 start = expected.low;
  if (truth) {
    for (const KeptBodies& bodies : truth->bodies) expected.add(bodies.columns());
  }
  const double farthest = kFarthest * (expected.size() + smallest_ + 1);
  for (std::size_t n = 0; n < samples_.size(); ++n) {
    if (!is_within(bodies(n), start, farthest)) {
      count_ = n;
      break;
    }
    bounds_.add(bodies(n));
  }
  position_seen_ = kPositionSeen * std::max(bounds_.size(), smallest_);
}

bool Motion::is_like_truth() const {
  if (!truth_ || truth_->bodies.size() < samples_.size() || count_ < samples_.size()) return false;
  for (std::size_t n = 0; n < count_; ++n) {
    if (difference(bodies(n), truth_->bodies[n].columns()) > 1) return false;
  }
  return true;
}

std::vector<std::size_t> Motion::candidates() const {
  const double poses = static_cast<double>(count_) * scene_.bodies.size();
  const auto stride = static_cast<std::size_t>(std::ceil(std::max(1.0, poses / kMostPoses)));
  std::vector<std::size_t> chosen;
  for (std::size_t from = 0; from < count_; from += stride) {
    std::size_t best = from;
    double jump = stride > 1 ? jump_at(from) : 0;
    for (std::size_t n = from + 1; n < std::min(from + stride, count_); ++n) {
      if (const double here = jump_at(n); here > jump) best = n, jump = here;
    }
    chosen.push_back(best);
  }
  if (!chosen.empty()) chosen.front() = 0;
  if (!chosen.empty() && chosen.back() != count_ - 1) chosen.push_back(count_ - 1);
  return chosen;
}

double Motion::difference(BodyColumns a, BodyColumns b) const {
  double worst = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    worst = std::max(worst, (a.position(i) - b.position(i)).norm() / position_seen_);
    const double angle = a.orientation(i).normalized().angularDistance(b.orientation(i).normalized());
    worst = std::max(worst, angle / kTurnSeen);
  }
  return worst;
}

double Motion::jump_at(std::size_t n) const {
  double jump = 0;
  for (std::size_t i = 0; n > 0 && i < scene_.bodies.size(); ++i) {
    jump = std::max(jump, (bodies(n).velocity(i) - bodies(n - 1).velocity(i)).norm());
  }
  return jump;
}

Poses::Poses(const Motion& motion, const std::vector<std::size_t>& samples)
    : samples_(samples), position_seen_(motion.position_seen()) {
  for (const std::size_t n : samples) {
    const BodyColumns bodies = motion.bodies(n);
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      positions_.push_back(bodies.position(i));
      turns_.push_back(bodies.orientation(i).normalized().coeffs());
    }
  }
  bodies_ = samples.empty() ? 0 : positions_.size() / samples.size();
}

double Poses::deviation(std::size_t n, std::size_t a, std::size_t b) const {
  const double from_a = static_cast<double>(samples_[n] - samples_[a]);
  const double share = from_a / static_cast<double>(samples_[b] - samples_[a]);
  double position = 0, chord = 0;
  for (std::size_t i = 0; i < bodies_; ++i) {
    const std::size_t here = n * bodies_ + i, before = a * bodies_ + i, after = b * bodies_ + i;
    const Vec3 line = (1 - share) * positions_[before] + share * positions_[after];
    position = std::max(position, (positions_[here] - line).squaredNorm());
    const double sign = turns_[before].dot(turns_[after]) < 0 ? -1 : 1;
    const Eigen::Vector4d between = ((1 - share) * turns_[before] + share * sign * turns_[after]).normalized();
    chord = std::max(chord, 1 - std::abs(between.dot(turns_[here])));
  }
  // Unit quaternions half an angle apart have a product of its cosine.
  const double angle = 2 * std::sqrt(2 * chord);
  return std::max(std::sqrt(position) / position_seen_, angle / kTurnSeen);
}

}  // namespace rigor::inline report
