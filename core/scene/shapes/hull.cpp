#include "core/scene/shapes/hull.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <utility>

// Qhull's header is C with macros of short names; only this file sees it.
extern "C" {
#include <libqhull_r/qhull_ra.h>
}

#include "core/base/error.h"
#include "core/scene/shapes/solid_integrals.h"

namespace rigor::inline scene {
namespace {

// Of the volume of a ball with the hull's bounding radius. A hull with less is flat, and its faces are noise.
constexpr double kFlat = 1e-9;

// The facets of a hull: lists of numbers of points, anticlockwise as seen from outside.
using Facets = std::vector<std::vector<int>>;

// Qhull in its own memory, which it frees at the end.
class Qhull {
 public:
  explicit Qhull(const std::vector<Vec3>& points) : messages_(std::fopen("/dev/null", "w")) {
    for (const Vec3& point : points) coordinates_.insert(coordinates_.end(), {point.x(), point.y(), point.z()});
    qh_zero(&qh_, messages_);
    char options[] = "qhull";
    failed_ = qh_new_qhull(&qh_, 3, static_cast<int>(points.size()), coordinates_.data(), False, options, nullptr,
                           messages_) != 0;
  }
  ~Qhull() {
    qh_freeqhull(&qh_, !qh_ALL);
    int kept = 0, total = 0;
    qh_memfreeshort(&qh_, &kept, &total);
    if (messages_) std::fclose(messages_);
  }
  Qhull(const Qhull&) = delete;
  Qhull& operator=(const Qhull&) = delete;

  bool failed() const { return failed_; }

  Facets facets() {
    Facets all;
    for (const facetT* facet = qh_.facet_list; facet && facet->next; facet = facet->next) {
      setT* vertices = qh_facet3vertex(&qh_, const_cast<facetT*>(facet));
      std::vector<int> corners;
      for (int i = 0; i < qh_setsize(&qh_, vertices); ++i) {
        const auto* vertex = static_cast<const vertexT*>(vertices->e[i].p);
        corners.push_back(qh_pointid(&qh_, vertex->point));
      }
      qh_settempfree(&qh_, &vertices);
      all.push_back(std::move(corners));
    }
    return all;
  }

 private:
  std::FILE* messages_;
  std::vector<coordT> coordinates_;
  qhT qh_ = {};
  bool failed_ = false;
};

// Newell's normal: exact for a plane polygon, and a mean for one that rounding bends.
Vec3 normal_of(const std::vector<Vec3>& points, const std::vector<int>& corners) {
  Vec3 sum = Vec3::Zero();
  const Vec3& origin = points[static_cast<std::size_t>(corners[0])];
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const Vec3 u = points[static_cast<std::size_t>(corners[i])] - origin,
               v = points[static_cast<std::size_t>(corners[i + 1])] - origin;
    sum += u.cross(v);
  }
  return sum.normalized();
}

[[noreturn]] void refuse_flat() {
  throw InputError("the points lie in one plane, so their hull has no volume; allowed: points that enclose a volume");
}

// Keeps the points that are corners, and numbers the facets' corners anew.
void keep_corners(const std::vector<Vec3>& points, const Facets& facets, Hull& hull) {
  std::vector<int> numbers(points.size(), -1);
  for (const std::vector<int>& facet : facets) {
    for (const int corner : facet) numbers[static_cast<std::size_t>(corner)] = 0;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (numbers[i] < 0) continue;
    numbers[i] = static_cast<int>(hull.points.size());
    hull.points.push_back(points[i]);
  }
  for (const std::vector<int>& facet : facets) {
    Hull::Face face;
    for (const int corner : facet) face.corners.push_back(numbers[static_cast<std::size_t>(corner)]);
    hull.faces.push_back(std::move(face));
  }
}

void find_planes(Hull& hull) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& point : hull.points) middle += point / static_cast<double>(hull.points.size());
  for (Hull::Face& face : hull.faces) {
    face.normal = normal_of(hull.points, face.corners);
    if (face.normal.dot(hull.points[static_cast<std::size_t>(face.corners[0])] - middle) < 0) {
      std::reverse(face.corners.begin(), face.corners.end());
      face.normal = -face.normal;
    }
    face.offset = -std::numeric_limits<double>::infinity();
    for (const Vec3& point : hull.points) face.offset = std::max(face.offset, face.normal.dot(point));
  }
}

// Each edge belongs to two faces that pass it in opposite directions.
bool find_edges(Hull& hull) {
  std::map<std::pair<int, int>, int> found;
  for (int f = 0; f < static_cast<int>(hull.faces.size()); ++f) {
    Hull::Face& face = hull.faces[static_cast<std::size_t>(f)];
    for (std::size_t i = 0; i < face.corners.size(); ++i) {
      const int from = face.corners[i], to = face.corners[(i + 1) % face.corners.size()];
      if (const auto other = found.find({to, from}); other != found.end()) {
        hull.edges[static_cast<std::size_t>(other->second)].right = f;
        face.edges.push_back(other->second);
        continue;
      }
      if (!found.emplace(std::pair(from, to), static_cast<int>(hull.edges.size())).second) return false;
      face.edges.push_back(static_cast<int>(hull.edges.size()));
      hull.edges.push_back({from, to, f, -1});
    }
  }
  return std::all_of(hull.edges.begin(), hull.edges.end(), [](const Hull::Edge& edge) { return edge.right >= 0; });
}

void integrate(Hull& hull) {
  SolidIntegrals solid(hull.points.front());
  for (const Hull::Face& face : hull.faces) {
    const auto corner = [&](std::size_t i) { return hull.points[static_cast<std::size_t>(face.corners[i])]; };
    for (std::size_t i = 1; i + 1 < face.corners.size(); ++i) solid.add(corner(0), corner(i), corner(i + 1));
  }
  hull.volume = solid.volume();
  if (!(hull.volume > 0)) refuse_flat();
  hull.centre = solid.centre(), hull.inertia = solid.inertia();
}

void measure(Hull& hull) {
  hull.bounding_radius = 0;
  double around = 0;  // m, about the centre
  for (const Vec3& point : hull.points) {
    hull.bounding_radius = std::max(hull.bounding_radius, point.norm());
    around = std::max(around, (point - hull.centre).norm());
  }
  hull.inradius = std::numeric_limits<double>::infinity();
  for (const Hull::Face& face : hull.faces)
    hull.inradius = std::min(hull.inradius, face.offset - face.normal.dot(hull.centre));
  if (!(hull.volume > kFlat * around * around * around)) refuse_flat();
}

}  // namespace

std::shared_ptr<const Hull> hull_of(const std::vector<Vec3>& points) {
  if (points.size() < 4)
    throw InputError(fmt::format("found {} points; allowed: at least 4 that do not lie in one plane", points.size()));
  if (points.size() > Hull::kMostPoints)
    throw InputError(fmt::format("found {} points; allowed: at most {}", points.size(), Hull::kMostPoints));
  if (!std::all_of(points.begin(), points.end(), [](const Vec3& point) { return point.allFinite(); }))
    throw InputError("found a point that is not finite; allowed: numbers in m");
  Qhull qhull(points);
  if (qhull.failed()) refuse_flat();
  auto hull = std::make_shared<Hull>();
  keep_corners(points, qhull.facets(), *hull);
  if (hull->points.size() > Hull::kMostCorners)
    throw InputError(
        fmt::format("the hull has {} corners; allowed: at most {}", hull->points.size(), Hull::kMostCorners));
  find_planes(*hull);
  integrate(*hull);
  measure(*hull);
  if (!find_edges(*hull))
    throw InputError("Qhull found no closed hull of the points; allowed: points that are not nearly flat");
  for (const Hull::Edge& edge : hull->edges) {
    const auto normal = [&](int face) { return hull->faces[static_cast<std::size_t>(face)].normal; };
    hull->least_cosine = std::min(hull->least_cosine, normal(edge.left).dot(normal(edge.right)));
  }
  return hull;
}

std::shared_ptr<const Hull> scaled_hull(const Hull& hull, double factor) {
  auto out = std::make_shared<Hull>(hull);
  for (Vec3& point : out->points) point *= factor;
  for (Hull::Face& face : out->faces) face.offset *= factor;
  const double area = factor * factor, volume = area * factor;
  out->volume *= volume, out->centre *= factor, out->inertia *= volume * area;
  out->bounding_radius *= factor, out->inradius *= factor;
  return out;
}

std::shared_ptr<const Hull> mirrored_hull(const Hull& hull) {
  std::vector<Vec3> points = hull.points;
  for (Vec3& point : points) point.x() = -point.x();
  return hull_of(points);
}

std::size_t Hull::furthest(const Vec3& n) const {
  std::size_t best = 0;
  double most = n.dot(points[0]);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double along = n.dot(points[i]);
    if (along > most) most = along, best = i;
  }
  return best;
}

TriangleMesh Hull::drawn() const {
  TriangleMesh mesh;
  for (const Face& face : faces) {
    const int first = static_cast<int>(mesh.points.size()), count = static_cast<int>(face.corners.size());
    for (const int corner : face.corners) {
      mesh.points.push_back(points[static_cast<std::size_t>(corner)]), mesh.normals.push_back(face.normal);
    }
    for (int i = 1; i + 1 < count; ++i) mesh.corners.insert(mesh.corners.end(), {first, first + i, first + i + 1});
  }
  return mesh;
}

}  // namespace rigor::inline scene
