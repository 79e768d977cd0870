#include "cases/analysis/divergence/parting.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace rigor::inline analysis {
namespace {

// A repeat that differs by a third of what two runs differ may explain that difference by chance.
constexpr double kOfSpread = 3;

int largest_axis(const Vec3& v) {
  Eigen::Index axis = 0;
  v.cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(axis);
}

struct Looked {
  Vec3 gap;
  double bound;
  std::array<const char*, 3> names;
  const char* unit;
  bool is_turn = false;
};

// The quantity that is farthest out of its bound.
Looked worst_quantity(const BodyGap& gap, const PartingBounds& bounds) {
  const std::array<Looked, 4> all = {
      Looked{gap.position, bounds.position, {"px", "py", "pz"}, "m"},
      Looked{gap.turn, bounds.orientation, {"turn about x", "turn about y", "turn about z"}, "rad", true},
      Looked{gap.velocity, bounds.velocity, {"vx", "vy", "vz"}, "m/s"},
      Looked{gap.angular_velocity, bounds.angular_velocity, {"wx", "wy", "wz"}, "rad/s"}};
  return *std::max_element(all.begin(), all.end(), [](const Looked& x, const Looked& y) {
    return x.gap.norm() / x.bound < y.gap.norm() / y.bound;
  });
}

const Vec3& part_of(const BodyState& state, const Looked& what) {
  switch (what.names[0][0]) {
    case 'p':
      return state.position;
    case 'v':
      return state.velocity;
    default:
      return state.angular_velocity;
  }
}

Parting parting_at(const MotionView& a, const MotionView& b, const PartingBounds& bounds, const LargestShare& worst,
                   double seconds_per_sample) {
  const auto i = static_cast<std::size_t>(worst.body);
  const BodyState in_a = a.body(worst.sample, i), in_b = b.body(worst.sample, i);
  const Looked what = worst_quantity(gap_between(in_a, in_b), bounds);
  const int axis = largest_axis(what.gap);
  Parting parting{seconds_per_sample * static_cast<double>(worst.sample),
                  worst.sample,
                  worst.body,
                  what.names[axis],
                  what.unit,
                  what.gap.norm(),
                  what.bound,
                  what.gap[axis],
                  {},
                  {}};
  if (!what.is_turn) parting.in_a = part_of(in_a, what)[axis], parting.in_b = part_of(in_b, what)[axis];
  return parting;
}

}  // namespace

BodyGap gap_between(const BodyState& a, const BodyState& b) {
  Quat turn = b.orientation * a.orientation.conjugate();
  if (turn.w() < 0) turn.coeffs() *= -1;
  const double sine = turn.vec().norm();
  const Vec3 axis = turn.vec();
  // 2 atan2(s, w)/s tends to 2 for a small sine.
  const double factor = sine > 1e-12 ? 2 * std::atan2(sine, turn.w()) / sine : 2;
  return {b.position - a.position, factor * axis, b.velocity - a.velocity, b.angular_velocity - a.angular_velocity};
}

BodyGap BodyGap::carried(double seconds) const {
  return {position + seconds * velocity, turn + seconds * angular_velocity, velocity, angular_velocity};
}

BodyGap& BodyGap::operator+=(const BodyGap& other) {
  position += other.position, turn += other.turn, velocity += other.velocity;
  angular_velocity += other.angular_velocity;
  return *this;
}

BodyGap BodyGap::operator*(double factor) const {
  return {factor * position, factor * turn, factor * velocity, factor * angular_velocity};
}

double share_of(const BodyGap& gap, const PartingBounds& bounds) {
  return std::max({gap.position.norm() / bounds.position, gap.turn.norm() / bounds.orientation,
                   gap.velocity.norm() / bounds.velocity, gap.angular_velocity.norm() / bounds.angular_velocity});
}

LargestShare share_at(const MotionView& a, const MotionView& b, const Scene& scene, const PartingBounds& bounds,
                      std::size_t sample) {
  LargestShare worst{0, sample, 0};
  for (std::size_t i = 0; i < a.bodies(); ++i) {
    if (scene.bodies[i].fixed) continue;
    const double share = share_of(gap_between(a.body(sample, i), b.body(sample, i)), bounds);
    if (share > worst.share) worst.share = share, worst.body = static_cast<int>(i);
  }
  return worst;
}

LargestShare largest_share(const MotionView& a, const MotionView& b, const Scene& scene, const PartingBounds& bounds,
                           std::size_t last) {
  LargestShare worst;
  for (std::size_t n = 0; n < std::min({a.samples(), b.samples(), last + 1}); ++n) {
    const LargestShare here = share_at(a, b, scene, bounds, n);
    if (here.share > worst.share) worst = here;
  }
  return worst;
}

std::optional<Parting> find_parting(const MotionView& a, const MotionView& b, const Scene& scene,
                                    const PartingBounds& bounds, double seconds_per_sample,
                                    const std::vector<double>& spread) {
  for (std::size_t n = 0; n < std::min(a.samples(), b.samples()); ++n) {
    const LargestShare worst = share_at(a, b, scene, bounds, n);
    const double own = n < spread.size() ? spread[n] : 0;
    if (worst.share > 1 && worst.share > kOfSpread * own) return parting_at(a, b, bounds, worst, seconds_per_sample);
  }
  return {};
}

}  // namespace rigor::inline analysis
