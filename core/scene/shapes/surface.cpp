#include "core/scene/shapes/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "core/base/error.h"
#include "core/scene/shapes/mesh.h"
#include "core/scene/shapes/solid_integrals.h"

namespace rigor::inline scene {
namespace {

constexpr double kFlatEdge = 1e-6;    // the sine between triangles that count as one plane: single precision in files
constexpr double kNoArea = 1e-12;     // of the square of a triangle's longest edge
constexpr double kFlatVolume = 1e-9;  // of a ball with the bounding radius: a mesh with less is flat
constexpr int kMostInLeaf = 4;

std::size_t index_of(int i) { return static_cast<std::size_t>(i); }

std::string shown_triangle(std::size_t t) { return fmt::format("triangle {}", t + 1); }

struct ByCoordinates {
  bool operator()(const Vec3& p, const Vec3& q) const {
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  }
};

}  // namespace

class SurfaceBuilder {
 public:
  void add_points(const std::vector<Vec3>& points) {
    if (!std::all_of(points.begin(), points.end(), [](const Vec3& p) { return p.allFinite(); }))
      throw InputError("found a point that is not finite; allowed: numbers in m");
    made_->points = points;
  }

  // Files of triangles alone have each point several times.
  void add_joined(const std::vector<Vec3>& points, std::vector<Corners>& triangles) {
    std::map<Vec3, int, ByCoordinates> places;
    std::vector<Vec3> joined;
    std::vector<int> numbers;
    for (const Vec3& point : points) {
      if (!point.allFinite()) throw InputError("found a point that is not finite; allowed: numbers in m");
      const Vec3 no_minus = point.array() + 0.0;  // -0 is 0
      const auto [at, is_new] = places.emplace(no_minus, static_cast<int>(joined.size()));
      if (is_new) joined.push_back(no_minus);
      numbers.push_back(at->second);
    }
    for (Corners& corners : triangles) {
      for (int& corner : corners) corner = numbers[index_of(corner)];
    }
    add_points(joined);
  }

  void add_triangles(const std::vector<Corners>& triangles) {
    if (triangles.empty() || triangles.size() > TriangleSurface::kMostTriangles)
      throw InputError(
          fmt::format("found {} triangles; allowed: 1 to {}", triangles.size(), TriangleSurface::kMostTriangles));
    for (std::size_t t = 0; t < triangles.size(); ++t) {
      TriangleSurface::Triangle triangle{.corners = triangles[t]};
      const Vec3 a = corner(triangle, 0), u = corner(triangle, 1) - a, v = corner(triangle, 2) - a, n = u.cross(v);
      const double longest = std::max({u.squaredNorm(), v.squaredNorm(), (u - v).squaredNorm()});
      if (!(n.norm() > kNoArea * longest))
        throw InputError(
            fmt::format("{} has no area; allowed: three corners that do not lie on a line", shown_triangle(t)));
      triangle.normal = n.normalized();
      made_->triangles.push_back(triangle);
    }
  }

  // Which triangles lie side by side. In a closed mesh each edge belongs to two, which pass it in opposite directions.
  void join_edges(bool is_closed) {
    std::map<std::pair<int, int>, std::pair<std::size_t, std::size_t>> passed;
    for (std::size_t t = 0; t < made_->triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        const int from = made_->triangles[t].corners[k], to = made_->triangles[t].corners[(k + 1) % 3];
        if (!passed.emplace(std::pair(from, to), std::pair(t, k)).second) refuse_edge(t, "another one passes, too");
      }
    }
    for (const auto& [edge, at] : passed) {
      const auto other = passed.find({edge.second, edge.first});
      if (other != passed.end())
        made_->triangles[at.first].beside[at.second] = static_cast<int>(other->second.first);
      else if (is_closed)
        refuse_edge(at.first, "no other triangle has: the mesh is open there");
    }
  }

  void measure() {
    TriangleSurface& made = *made_;
    made.low = made.high = made.points.front();
    for (const Vec3& point : made.points) {
      made.low = made.low.cwiseMin(point), made.high = made.high.cwiseMax(point);
      made.bounding_radius = std::max(made.bounding_radius, point.norm());
    }
  }
  void integrate() {
    TriangleSurface& made = *made_;
    SolidIntegrals solid(0.5 * (made.low + made.high));
    for (const TriangleSurface::Triangle& triangle : made.triangles)
      solid.add(corner(triangle, 0), corner(triangle, 1), corner(triangle, 2));
    const double around = 0.5 * (made.high - made.low).norm(), flat = kFlatVolume * around * around * around;
    if (solid.volume() < -flat)
      throw InputError("its triangles look inwards; allowed: corners anticlockwise as seen from outside");
    if (!(solid.volume() > flat)) throw InputError("the mesh encloses no volume; allowed: triangles around a volume");
    made.volume = solid.volume(), made.centre = solid.centre(), made.inertia = solid.inertia();
  }

  void find_ridges() {
    TriangleSurface& made = *made_;
    made.ridges_of.resize(made.triangles.size()), made.peaks_of.resize(made.triangles.size());
    std::vector<char> is_peak(made.points.size());
    std::vector<std::vector<int>> beside(made.points.size());  // by point: those at the other ends of its edges
    for (std::size_t t = 0; t < made.triangles.size(); ++t) {
      const TriangleSurface::Triangle& left = made.triangles[t];
      for (std::size_t k = 0; k < 3; ++k) {
        const int from = left.corners[k], to = left.corners[(k + 1) % 3];
        beside[index_of(from)].push_back(to);
        if (left.beside[k] < 0) beside[index_of(to)].push_back(from);
        if (left.beside[k] < static_cast<int>(t)) continue;  // once for both, and not at a border
        const TriangleSurface::Triangle& right = made.triangles[index_of(left.beside[k])];
        const Vec3 along = (made.points[index_of(to)] - made.points[index_of(from)]).normalized();
        const Vec3 into_left = left.normal.cross(along), into_right = along.cross(right.normal);
        if (!(left.normal.dot(into_right) < -kFlatEdge)) continue;
        made.ridges_of[t].push_back(static_cast<int>(made.ridges.size()));
        made.ridges.push_back({from, to, static_cast<int>(t), left.beside[k], into_left, into_right});
        is_peak[index_of(from)] = is_peak[index_of(to)] = 1;
      }
    }
    for (std::size_t t = 0; t < made.triangles.size(); ++t) {
      for (const int point : made.triangles[t].corners) {
        if (is_peak[index_of(point)] == 0) continue;
        is_peak[index_of(point)] = 0;  // once
        TriangleSurface::Peak peak{point, {}};
        for (const int end : beside[index_of(point)])
          peak.edges.push_back((made.points[index_of(end)] - made.points[index_of(point)]).normalized());
        made.peaks_of[t].push_back(static_cast<int>(made.peaks.size()));
        made.peaks.push_back(std::move(peak));
      }
    }
  }

  // Regions of triangles that lie in one plane with their neighbours.
  void find_patches() {
    int count = 0;
    std::vector<std::size_t> open;
    for (std::size_t start = 0; start < made_->triangles.size(); ++start) {
      if (made_->triangles[start].patch >= 0) continue;
      made_->triangles[start].patch = count;
      open.assign(1, start);
      while (!open.empty()) {
        const TriangleSurface::Triangle& at = made_->triangles[open.back()];
        open.pop_back();
        for (const int other : at.beside) {
          if (other < 0) continue;
          TriangleSurface::Triangle& beside = made_->triangles[index_of(other)];
          // Against the first one, so that a region that bends a little at each edge is not one.
          const Vec3& normal = made_->triangles[start].normal;
          if (beside.patch >= 0 || normal.cross(beside.normal).norm() > kFlatEdge || normal.dot(beside.normal) < 0)
            continue;
          beside.patch = count;
          open.push_back(index_of(other));
        }
      }
      ++count;
    }
  }

  void plant_tree() {
    made_->order.resize(made_->triangles.size());
    std::iota(made_->order.begin(), made_->order.end(), 0);
    split(0, static_cast<int>(made_->order.size()));
  }

  // An edge that passes through a triangle with which it shares no corner.
  void refuse_cuts() const {
    const TriangleSurface& made = *made_;
    std::vector<int> near;
    for (std::size_t t = 0; t < made.triangles.size(); ++t) {
      for (std::size_t k = 0; k < 3; ++k) {
        if (made.triangles[t].beside[k] < static_cast<int>(t)) continue;
        const int from = made.triangles[t].corners[k], to = made.triangles[t].corners[(k + 1) % 3];
        const Vec3 &p = made.points[index_of(from)], &q = made.points[index_of(to)];
        near.clear();
        made.find_near(p.cwiseMin(q), p.cwiseMax(q), near);
        for (const int other : near) {
          if (passes_through(p, q, from, to, made.triangles[index_of(other)]))
            throw InputError(
                fmt::format("{} and {} cut each other; allowed: triangles that meet at edges and corners alone",
                            shown_triangle(t), shown_triangle(index_of(other))));
        }
      }
    }
  }

  std::shared_ptr<const TriangleSurface> take() { return made_; }

 private:
  Vec3 corner(const TriangleSurface::Triangle& triangle, std::size_t k) const {
    return made_->points[index_of(triangle.corners[k])];
  }

  [[noreturn]] void refuse_edge(std::size_t t, const std::string& what) const {
    throw InputError(fmt::format("{} has an edge that {}; allowed: edges that two triangles share, each from its side",
                                 shown_triangle(t), what));
  }

  // Both ends lie well on different sides, and the edge meets the triangle's inside.
  bool passes_through(const Vec3& p, const Vec3& q, int from, int to, const TriangleSurface::Triangle& triangle) const {
    for (const int own : triangle.corners)
      if (own == from || own == to) return false;
    constexpr double kTouching = 1e-9;  // of the edge
    const Vec3 a = corner(triangle, 0), line = q - p;
    const double at_p = triangle.normal.dot(p - a), at_q = triangle.normal.dot(q - a), least = kTouching * line.norm();
    if (!(std::min(at_p, at_q) < -least && std::max(at_p, at_q) > least)) return false;
    const Vec3 at = p + at_p / (at_p - at_q) * line;
    for (std::size_t k = 0; k < 3; ++k) {
      const Vec3 start = corner(triangle, k), side = corner(triangle, (k + 1) % 3) - start;
      if (!(triangle.normal.dot(side.cross(at - start)) > least * side.norm())) return false;
    }
    return true;
  }

  // In halves along the longest side of the box around the middles.
  void split(int first, int last) {
    TriangleSurface& made = *made_;
    const std::size_t own = made.nodes.size();
    made.nodes.push_back({made.high, made.low, first, last - first, -1});
    Vec3 least = made.high, most = made.low;
    for (int i = first; i < last; ++i) {
      const TriangleSurface::Triangle& triangle = made.triangles[index_of(made.order[index_of(i)])];
      for (std::size_t k = 0; k < 3; ++k) {
        made.nodes[own].low = made.nodes[own].low.cwiseMin(corner(triangle, k));
        made.nodes[own].high = made.nodes[own].high.cwiseMax(corner(triangle, k));
      }
      least = least.cwiseMin(middle(triangle)), most = most.cwiseMax(middle(triangle));
    }
    if (last - first <= kMostInLeaf) return;
    int axis = 0;
    (most - least).maxCoeff(&axis);
    const int half = first + (last - first) / 2;
    std::nth_element(made.order.begin() + first, made.order.begin() + half, made.order.begin() + last,
                     [&](int x, int y) {
                       const double at_x = middle(made.triangles[index_of(x)])[axis],
                                    at_y = middle(made.triangles[index_of(y)])[axis];
                       return at_x != at_y ? at_x < at_y : x < y;
                     });
    made.nodes[own].count = 0;
    split(first, half);
    made.nodes[own].right = static_cast<int>(made.nodes.size());
    split(half, last);
  }

  Vec3 middle(const TriangleSurface::Triangle& triangle) const {
    return (corner(triangle, 0) + corner(triangle, 1) + corner(triangle, 2)) / 3;
  }

  std::shared_ptr<TriangleSurface> made_ = std::make_shared<TriangleSurface>();
};

TriangleMesh TriangleSurface::drawn() const {
  TriangleMesh mesh;
  for (const Triangle& triangle : triangles) {
    for (const int corner : triangle.corners) {
      mesh.corners.push_back(static_cast<int>(mesh.points.size()));
      mesh.points.push_back(points[index_of(corner)]), mesh.normals.push_back(triangle.normal);
    }
  }
  return mesh;
}

Vec3 SurfaceShape::support(const Vec3& n) const {
  return *std::max_element(surface->points.begin(), surface->points.end(),
                           [&](const Vec3& p, const Vec3& q) { return n.dot(p) < n.dot(q); });
}

std::shared_ptr<const TriangleSurface> closed_surface(const std::vector<Vec3>& points,
                                                      const std::vector<Corners>& triangles) {
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    for (const int corner : triangles[t]) {
      if (corner < 0 || index_of(corner) >= points.size())
        throw InputError(fmt::format("{} has corner {}; allowed: 0 to {}, the numbers of points", shown_triangle(t),
                                     corner, points.size() - 1));
    }
  }
  SurfaceBuilder builder;
  std::vector<Corners> joined = triangles;
  builder.add_joined(points, joined);
  builder.add_triangles(joined);
  builder.join_edges(true);
  builder.measure(), builder.integrate(), builder.find_ridges(), builder.find_patches(), builder.plant_tree();
  builder.refuse_cuts();
  return builder.take();
}

std::shared_ptr<const TriangleSurface> closed_surface(const TriangleMesh& drawn) {
  std::vector<Corners> triangles;
  for (std::size_t k = 0; k + 2 < drawn.corners.size(); k += 3)
    triangles.push_back({drawn.corners[k], drawn.corners[k + 1], drawn.corners[k + 2]});
  return closed_surface(drawn.points, triangles);
}

std::shared_ptr<const TriangleSurface> height_surface(const std::array<double, 2>& size,
                                                      const std::vector<std::vector<double>>& heights) {
  const std::size_t rows = heights.size(), columns = rows == 0 ? 0 : heights.front().size();
  if (rows < 2 || columns < 2)
    throw InputError(fmt::format("found {} by {} heights; allowed: at least 2 rows of at least 2", rows, columns));
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < rows; ++i) {
    if (heights[i].size() != columns)
      throw InputError(fmt::format("row {} has {} heights, and row 1 has {}; allowed: rows of one length", i + 1,
                                   heights[i].size(), columns));
    const double y = size[1] * (static_cast<double>(i) / static_cast<double>(rows - 1) - 0.5);
    for (std::size_t k = 0; k < columns; ++k)
      points.emplace_back(size[0] * (static_cast<double>(k) / static_cast<double>(columns - 1) - 0.5), y,
                          heights[i][k]);
  }
  std::vector<Corners> triangles;
  for (std::size_t i = 0; i + 1 < rows; ++i) {
    for (std::size_t k = 0; k + 1 < columns; ++k) {
      const int low = static_cast<int>(i * columns + k), high = low + static_cast<int>(columns);
      triangles.push_back({low, low + 1, high + 1}), triangles.push_back({low, high + 1, high});
    }
  }
  SurfaceBuilder builder;
  builder.add_points(points), builder.add_triangles(triangles), builder.join_edges(false);
  builder.measure(), builder.find_ridges(), builder.find_patches(), builder.plant_tree();
  return builder.take();
}

void TriangleSurface::scale(double factor) {
  for (Vec3& point : points) point *= factor;
  for (Node& node : nodes) node.low *= factor, node.high *= factor;
  volume *= std::pow(factor, 3), inertia *= std::pow(factor, 5);
  centre *= factor, bounding_radius *= factor, low *= factor, high *= factor;
}

std::shared_ptr<const TriangleSurface> scaled_surface(const TriangleSurface& surface, double factor) {
  auto scaled = std::make_shared<TriangleSurface>(surface);
  scaled->scale(factor);
  return scaled;
}

}  // namespace rigor::inline scene
