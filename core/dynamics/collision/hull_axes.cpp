#include "core/dynamics/collision/placed_hull.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace rigor::inline dynamics {
namespace {

constexpr double kShareOfBall = 1 - 1e-9;  // of an inscribed ball: what is inside in spite of rounding

// The other's point that lies deepest behind a face.
int deepest_behind(PlacedHull& of, std::size_t face, const PlacedHull& other) {
  int& deepest = of.deepest[face];
  if (deepest >= 0) return deepest;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < other.points.size(); ++i) {
    const double along = of.normals[face].dot(other.points[i]);
    if (along < least) least = along, deepest = static_cast<int>(i);
  }
  return deepest;
}

// Whether the other's inscribed ball allows a separation of more than `found` along an axis between the normals of the
// edge's faces. With w the way from the edge to the ball's centre, l and r its parts along the normals and c their
// cosine, the largest part of w between the normals has the square (l² + r² - 2 c l r) / (1 - c²).
bool may_part(const PlacedHull& of, const Hull::Edge& edge, const PlacedHull& other, double found) {
  constexpr double kNearlyParallel = 1e-6;
  const std::size_t left = PlacedHull::index(edge.left), right = PlacedHull::index(edge.right);
  const double ball = kShareOfBall * other.inradius, least = found + ball;
  const double l = of.bounds[left] + ball, r = of.bounds[right] + ball;
  if (least <= 0 || l > least || r > least) return true;
  const double c = of.normals[left].dot(of.normals[right]), square = 1 - c * c;
  if (square < kNearlyParallel) return true;
  const bool is_between = r >= c * l && l >= c * r;
  return is_between && l * l + r * r - 2 * c * l * r > least * least * square;
}

// Calls visit(edge) for those that may_part() could allow. An axis between the normals of two faces is within 45.6
// degrees of one of them, if the normals are at most 91 degrees apart.
template <typename Visit>
void for_each_near_edge(const PlacedHull& of, const PlacedHull& other, double found, const Visit& visit) {
  constexpr double kLeastCosine = -0.02, kHalfRightAngle = 0.7;  // its cosine, sqrt((1 + kLeastCosine) / 2)
  const Hull& hull = *of.hull;
  const double ball = kShareOfBall * other.inradius, least = kHalfRightAngle * (found + ball) - ball;
  if (hull.least_cosine < kLeastCosine || found + ball <= 0) {
    for (std::size_t e = 0; e < hull.edges.size(); ++e) visit(static_cast<int>(e));
    return;
  }
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    if (of.bounds[f] < least) continue;
    for (const int e : hull.faces[f].edges) {
      const Hull::Edge& edge = hull.edges[PlacedHull::index(e)];
      const std::size_t beside = PlacedHull::index(edge.left == static_cast<int>(f) ? edge.right : edge.left);
      if (beside > f || of.bounds[beside] < least) visit(e);  // once
    }
  }
}

// The edges that can give an axis of more separation than `found`.
void edges_worth_a_look(PlacedHull& of, const PlacedHull& other, double found, std::vector<int>& out) {
  out.clear();
  const double deep = std::min(found, 0.0);
  for_each_near_edge(of, other, found, [&](int e) {
    const Hull::Edge& edge = of.hull->edges[PlacedHull::index(e)];
    if (!may_part(of, edge, other, found)) return;
    const std::size_t left = PlacedHull::index(edge.left), right = PlacedHull::index(edge.right);
    const auto is_behind = [&](int point) {
      const Vec3& p = other.points[PlacedHull::index(point)];
      return of.normals[left].dot(p) - of.offsets[left] < deep && of.normals[right].dot(p) - of.offsets[right] < deep;
    };
    if (!is_behind(deepest_behind(of, left, other)) && !is_behind(deepest_behind(of, right, other))) out.push_back(e);
  });
  std::sort(out.begin(), out.end());
}

}  // namespace

// Over the faces of `of`; n points out of it. The other's inscribed ball bounds each separation from above, so few
// faces need a look at all of its points. The first of equal ones counts.
HullAxis best_face_of(PlacedHull& of, const PlacedHull& other) {
  const std::size_t faces = of.normals.size();
  of.deepest.assign(faces, -1), of.bounds.resize(faces);
  for (std::size_t f = 0; f < faces; ++f)
    of.bounds[f] = of.normals[f].dot(other.centre) - of.offsets[f] - kShareOfBall * other.inradius;
  HullAxis best;
  const auto look_at = [&](std::size_t f) {
    const Vec3& deepest = other.points[PlacedHull::index(deepest_behind(of, f, other))];
    const double separation = of.normals[f].dot(deepest) - of.offsets[f];
    const bool is_first = separation == best.separation && static_cast<int>(f) < best.a;
    if (separation > best.separation || is_first) best = {separation, of.normals[f], static_cast<int>(f), -1};
  };
  const auto nearest = std::max_element(of.bounds.begin(), of.bounds.end()) - of.bounds.begin();
  look_at(static_cast<std::size_t>(nearest));
  for (std::size_t f = 0; f < faces; ++f)
    if (of.bounds[f] >= best.separation && static_cast<std::ptrdiff_t>(f) != nearest) look_at(f);
  return best;
}

HullAxis best_edges_of(PlacedHull& a, PlacedHull& b, double found) {
  constexpr double kParallel = 1e-6;  // the sine squared
  static thread_local std::vector<int> edges_a, edges_b;
  edges_worth_a_look(a, b, found, edges_a);
  edges_worth_a_look(b, a, found, edges_b);
  HullAxis best;
  for (const int i : edges_a) {
    const Hull::Edge& of_a = a.hull->edges[PlacedHull::index(i)];
    const Vec3 u = a.edge(of_a);
    const Vec3 &left_a = a.normals[PlacedHull::index(of_a.left)], &right_a = a.normals[PlacedHull::index(of_a.right)];
    for (const int k : edges_b) {
      const Hull::Edge& of_b = b.hull->edges[PlacedHull::index(k)];
      const Vec3 v = b.edge(of_b);
      const double left_b = -b.normals[PlacedHull::index(of_b.left)].dot(u),
                   right_b = -b.normals[PlacedHull::index(of_b.right)].dot(u);
      if (!(left_b * right_b < 0)) continue;
      const double along_left = left_a.dot(v), along_right = right_a.dot(v);
      if (!(along_left * along_right < 0 && left_b * along_right > 0)) continue;
      Vec3 n = u.cross(v);
      const double square = n.squaredNorm();
      if (square < kParallel * u.squaredNorm() * v.squaredNorm()) continue;
      const Vec3& at = a.points[PlacedHull::index(of_a.from)];
      n /= (n.dot(at - a.centre) < 0 ? -1 : 1) * std::sqrt(square);
      const double separation = n.dot(b.points[PlacedHull::index(of_b.from)] - at);
      if (separation > best.separation) best = {separation, n, i, k};
    }
  }
  return best;
}

}  // namespace rigor::inline dynamics
