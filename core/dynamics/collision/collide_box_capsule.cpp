// A box and a capsule. The squared distance from the box to a point on the capsule's axis is convex and piecewise
// quadratic. The pieces end where the point passes a face's plane, so the minimum is exact. If the axis itself enters
// the box, it is pushed out along the axis of least overlap, among the box's normals and their cross products with it.
// If the capsule lies along a face or an edge, both ends of the part over it are contact points.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/dynamics/collision/side_by_side.h"

namespace rigor::inline dynamics {
namespace {

// In the box's frame: the points c + s u with |s| <= half.
struct Segment {
  Vec3 c, u;
  double half;
  Vec3 at(double s) const { return c + s * u; }
};

Vec3 nearest_in_box(const Vec3& p, const Vec3& half) { return p.cwiseMax(-half).cwiseMin(half); }

// Half the derivative of the squared distance by s; it never falls as s grows.
double slope(const Segment& segment, const Vec3& half, double s) {
  const Vec3 p = segment.at(s);
  return segment.u.dot(p - nearest_in_box(p, half));
}

double nearest_on_segment(const Segment& segment, const Vec3& half) {
  std::array<double, 8> bounds = {-segment.half};  // in ascending order
  int count = 1;
  const auto insert = [&](double s) {
    int at = count++;
    for (; at > 0 && bounds[at - 1] > s; --at) bounds[at] = bounds[at - 1];
    bounds[at] = s;
  };
  for (int k = 0; k < 3; ++k) {
    if (segment.u[k] == 0) continue;
    for (const double face : {-half[k], half[k]}) {
      const double s = (face - segment.c[k]) / segment.u[k];
      if (std::abs(s) < segment.half) insert(s);
    }
  }
  insert(segment.half);
  double low = bounds[0], slope_low = slope(segment, half, low);
  if (slope_low >= 0) return low;
  for (int i = 1; i < count; ++i) {
    const double high = bounds[i], slope_high = slope(segment, half, high);
    if (slope_high >= 0)
      return slope_high == slope_low ? low : low - slope_low * (high - low) / (slope_high - slope_low);
    low = high, slope_low = slope_high;
  }
  return low;
}

struct OverlapAxis {
  double separation = -std::numeric_limits<double>::infinity();
  Vec3 n = Vec3::Zero();  // from the box to the axis, in the box's frame
};

void try_axis(const Vec3& direction, const Segment& segment, const Vec3& half, OverlapAxis& best) {
  const Vec3 n = direction.dot(segment.c) < 0 ? Vec3(-direction) : direction;
  const double separation = n.dot(segment.c) - segment.half * std::abs(n.dot(segment.u)) - n.cwiseAbs().dot(half);
  if (separation > best.separation) best = {separation, n};
}

// For an axis that passes through the box.
OverlapAxis axis_of_least_overlap(const Segment& segment, const Vec3& half) {
  OverlapAxis best;
  for (int k = 0; k < 3; ++k) try_axis(Vec3::Unit(k), segment, half, best);
  for (int k = 0; k < 3; ++k) {
    const Vec3 n = Vec3::Unit(k).cross(segment.u);
    if (n.squaredNorm() > 1e-6) try_axis(n.normalized(), segment, half, best);
  }
  return best;
}

// The axis of the box along which n looks, or -1.
int face_of(const Vec3& n) {
  constexpr double kStraight = 1 - 1e-12;  // the cosine: along the axis but for rounding
  int axis = 0;
  return n.cwiseAbs().maxCoeff(&axis) > kStraight ? axis : -1;
}

// The part of the segment that lies over the face across `axis`; empty if low >= high.
std::pair<double, double> part_over(const Segment& segment, const Vec3& half, int axis) {
  double low = -segment.half, high = segment.half;
  for (int k = 0; k < 3; ++k) {
    if (k == axis) continue;
    if (segment.u[k] == 0) {
      if (std::abs(segment.c[k]) > half[k]) return {0, 0};
      continue;
    }
    const double s = (-half[k] - segment.c[k]) / segment.u[k], t = (half[k] - segment.c[k]) / segment.u[k];
    low = std::max(low, std::min(s, t)), high = std::min(high, std::max(s, t));
  }
  return {low, high};
}

// The edge along which the capsule lies, in the box's frame: the nearest point `p` of the axis is outside of both its
// sides. None if no edge is nearly parallel to the axis.
std::optional<RoundLine> edge_along(const Segment& segment, const Vec3& half, const Vec3& p) {
  int along = 0;
  segment.u.cwiseAbs().maxCoeff(&along);
  Vec3 centre = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    if (k == along) continue;
    if (!(std::abs(p[k]) > half[k])) return {};
    centre[k] = std::copysign(half[k], p[k]);
  }
  return RoundLine{centre, Vec3::Unit(along), half[along], 0};
}

// From the box's frame to W.
RoundLine placed(const RoundLine& line, const Pose& pose) {
  return {pose.p + pose.R * line.centre, pose.R * line.direction, line.half, line.radius};
}

}  // namespace

void collide_box_capsule(const Box& box, const Pose& pose_a, const Capsule& capsule, const Pose& pose_b,
                         Manifold& out) {
  const Vec3 half = 0.5 * box.size;
  const Segment segment{pose_a.R.transpose() * (pose_b.p - pose_a.p), pose_a.R.transpose() * pose_b.R.col(2),
                        0.5 * capsule.length};
  const double s = nearest_on_segment(segment, half);
  const Vec3 p = segment.at(s), line = p - nearest_in_box(p, half);
  const double distance = line.norm();
  const OverlapAxis best = distance > 1e-12 * half.maxCoeff() ? OverlapAxis{distance, line / distance}
                                                              : axis_of_least_overlap(segment, half);

  const auto add = [&](const Vec3& axis_point, double height, std::uint32_t feature) {
    const double gap = height - capsule.radius;
    const Vec3 point = axis_point - (capsule.radius + 0.5 * gap) * best.n;
    out.add(-(pose_a.R * best.n), pose_a.p + pose_a.R * point, gap, feature);
  };
  const int axis = face_of(best.n);
  constexpr double kAlong = 0.1;  // the sine of the angle to the face: steeper, and the nearest point is alone
  if (axis >= 0 && std::abs(segment.u[axis]) < kAlong) {
    const auto [low, high] = part_over(segment, half, axis);
    if (low < high) {
      const double sign = best.n[axis] < 0 ? -1 : 1;
      for (const std::uint32_t end : {0u, 1u}) {
        const Vec3 at = segment.at(end ? high : low);
        add(at, sign * at[axis] - half[axis], end);
      }
      return;
    }
  }
  const RoundLine capsule_line{pose_b.p, pose_b.R.col(2), 0.5 * capsule.length, capsule.radius};
  const auto edge = edge_along(segment, half, p);
  if (edge && add_side_by_side(placed(*edge, pose_a), capsule_line, out)) return;
  // Inside, the end that is deepest along the normal stands for the axis.
  const Vec3 deepest =
      distance > 1e-12 * half.maxCoeff() ? p : segment.at(segment.u.dot(best.n) > 0 ? -segment.half : segment.half);
  add(deepest, best.separation, 2);
}

}  // namespace rigor::inline dynamics
