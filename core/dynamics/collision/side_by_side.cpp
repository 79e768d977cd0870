#include "core/dynamics/collision/side_by_side.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline dynamics {
namespace {

double sine_squared(const RoundLine& a, const RoundLine& b) { return a.direction.cross(b.direction).squaredNorm(); }

double foot_on(const RoundLine& line, const Vec3& point) {
  return std::clamp(line.direction.dot(point - line.centre), -line.half, line.half);
}

struct OnLines {
  double s, t;  // m
};

// The pair at one end of the part of `a` that lies beside `b`: an end of one line, and its foot on the other.
OnLines end_of_part(const RoundLine& a, const RoundLine& b, double sign) {
  const double end_of_b = std::copysign(b.half, sign * a.direction.dot(b.direction)),
               s = a.direction.dot(b.at(end_of_b) - a.centre);
  if (sign * s < a.half) return {s, end_of_b};
  return {sign * a.half, foot_on(b, a.at(sign * a.half))};
}

}  // namespace

// Each line's nearest point to the other's, from the common perpendicular on (Ericson, Real-Time Collision Detection,
// 2005, section 5.1.9). Parallel lines have none, and any start serves.
std::pair<double, double> nearest_on_lines(const RoundLine& a, const RoundLine& b) {
  const Vec3 &u = a.direction, &v = b.direction, line = b.centre - a.centre;
  const double cosine = u.dot(v), square = sine_squared(a, b);
  double s = 0;
  if (square > kParallelLines * kParallelLines)
    s = std::clamp((u.dot(line) - cosine * v.dot(line)) / square, -a.half, a.half);
  double t = s * cosine - v.dot(line);
  if (std::abs(t) > b.half || s == 0) {
    t = std::clamp(t, -b.half, b.half);
    s = std::clamp(t * cosine + u.dot(line), -a.half, a.half);
  }
  return {s, t};
}

void add_on_lines(const RoundLine& a, double s, const RoundLine& b, double t, std::uint32_t feature, Manifold& out) {
  const Vec3 line = a.at(s) - b.at(t);
  const double distance = line.norm();
  const Vec3 n = distance > 0 ? Vec3(line / distance) : Vec3::UnitZ();
  const double gap = distance - a.radius - b.radius;
  out.add(n, b.at(t) + (b.radius + 0.5 * gap) * n, gap, feature);
}

bool add_side_by_side(const RoundLine& a, const RoundLine& b, Manifold& out) {
  const double square = sine_squared(a, b);
  if (square > kNearlyParallelLines * kNearlyParallelLines) return false;
  const OnLines low = end_of_part(a, b, -1), high = end_of_part(a, b, 1);
  if (!(low.s < high.s)) return false;
  const int first = out.size();
  add_on_lines(a, low.s, b, low.t, 0, out);
  add_on_lines(a, high.s, b, high.t, 1, out);
  const auto [s, t] = nearest_on_lines(a, b);
  const bool is_crossing = square > kParallelLines * kParallelLines && low.s < s && s < high.s && std::abs(t) < b.half;
  if (is_crossing) add_on_lines(a, s, b, t, 2, out);
  if (is_crossing) std::swap(out[first], out[out.size() - 1]);
  return true;
}

}  // namespace rigor::inline dynamics
