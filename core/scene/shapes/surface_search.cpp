// The searches of a surface's tree. They run in timed steps.
#include <algorithm>
#include <limits>

#include "core/scene/shapes/surface.h"

namespace rigor::inline scene {
namespace {

std::size_t place_of(int i) { return static_cast<std::size_t>(i); }

}  // namespace

template <typename Enters, typename LeftIsFirst, typename Visit>
void TriangleSurface::descend(const Enters& enters, const LeftIsFirst& left_is_first, const Visit& visit) const {
  static thread_local std::vector<int> open;
  open.assign(1, 0);
  while (!open.empty()) {
    const int at = open.back(), left = at + 1;
    const Node& node = nodes[place_of(at)];
    open.pop_back();
    if (!enters(node)) continue;
    for (int i = node.first; i < node.first + node.count; ++i) visit(order[place_of(i)]);
    if (node.count > 0) continue;
    const bool is_left = left_is_first(nodes[place_of(left)], nodes[place_of(node.right)]);
    open.push_back(is_left ? node.right : left), open.push_back(is_left ? left : node.right);
  }
}

void TriangleSurface::find_near(const Vec3& box_low, const Vec3& box_high, std::vector<int>& out) const {
  const auto overlaps = [&](const Vec3& its_low, const Vec3& its_high) {
    return (its_low.array() <= box_high.array()).all() && (box_low.array() <= its_high.array()).all();
  };
  descend([&](const Node& node) { return overlaps(node.low, node.high); },
          [](const Node&, const Node&) { return true; },
          [&](int t) {
            const Corners& c = triangles[place_of(t)].corners;
            const Vec3 &p = points[place_of(c[0])], &q = points[place_of(c[1])], &r = points[place_of(c[2])];
            if (overlaps(p.cwiseMin(q).cwiseMin(r), p.cwiseMax(q).cwiseMax(r))) out.push_back(t);
          });
}

Vec3 TriangleSurface::nearest_on(const Triangle& triangle, const Vec3& p) const {
  const Vec3& a = points[place_of(triangle.corners[0])];
  const Vec3 foot = p - triangle.normal.dot(p - a) * triangle.normal;
  bool is_inside = true;
  Vec3 best = foot;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3 &from = points[place_of(triangle.corners[k])],
               side = points[place_of(triangle.corners[(k + 1) % 3])] - from;
    if (triangle.normal.dot(side.cross(foot - from)) < 0) is_inside = false;
    const Vec3 at = from + std::clamp(side.dot(p - from) / side.squaredNorm(), 0.0, 1.0) * side;
    if (const double square = (p - at).squaredNorm(); square < least) least = square, best = at;
  }
  return is_inside ? foot : best;
}

// Nodes that are farther than what was found are left out; of two children the nearer comes first.
Vec3 TriangleSurface::nearest(const Vec3& p, double most) const {
  const auto square_to = [&](const Node& node) { return (p - p.cwiseMax(node.low).cwiseMin(node.high)).squaredNorm(); };
  Vec3 best = Vec3::Constant(std::numeric_limits<double>::infinity());
  double least = most * most;
  descend([&](const Node& node) { return square_to(node) <= least; },
          [&](const Node& left, const Node& right) { return square_to(left) < square_to(right); },
          [&](int t) {
            const Vec3 near = nearest_on(triangles[place_of(t)], p);
            if (const double square = (p - near).squaredNorm(); square <= least) least = square, best = near;
          });
  return best;
}

}  // namespace rigor::inline scene
