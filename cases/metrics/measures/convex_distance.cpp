#include "cases/metrics/measures/convex_distance.h"

#include <Eigen/LU>
#include <algorithm>
#include <boost/container/static_vector.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace rigor::inline metric {
namespace {

constexpr int kMostDistanceRounds = 256;
constexpr double kDistanceConverged = 1e-12;  // of the squared distance, or of the shapes' size
// A share of the shapes' size. Within this distance the first algorithm cannot tell a touch from an overlap.
constexpr double kTouch = 1e-9;

// A point of the Minkowski difference a - b, and the two points that it comes from.
struct Difference {
  Vec3 at, of_a, of_b;
};

class ConvexPair {
 public:
  ConvexPair(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b)
      : a_(a), b_(b), pose_a_(pose_a), pose_b_(pose_b), size_(rigor::bounding_radius(a) + rigor::bounding_radius(b)) {}

  Difference furthest(const Vec3& n) const {
    const Vec3 of_a = pose_a_.p + pose_a_.R * support(a_, pose_a_.R.transpose() * n),
               of_b = pose_b_.p + pose_b_.R * support(b_, -(pose_b_.R.transpose() * n));
    return {of_a - of_b, of_a, of_b};
  }
  Vec3 between() const {
    const Vec3 line = pose_a_.p - pose_b_.p;
    return line.norm() > 1e-9 * size_ ? line : Vec3::UnitZ();
  }
  double size() const { return size_; }

 private:
  const Shape& a_;
  const Shape& b_;
  const Pose& pose_a_;
  const Pose& pose_b_;
  double size_;  // m
};

using Simplex = boost::container::static_vector<Difference, 4>;
using Weights = boost::container::static_vector<double, 4>;

// The part of a simplex nearest to the origin, and the weights of its corners.
struct NearestPart {
  Simplex corners;
  Weights weights;
  Vec3 at = Vec3::Zero();
};

// The weights of the corners at the point nearest to the origin: of a line, a plane or space through all of them. That
// point may lie outside of the part. `Sides`: the number of corners but the first.
template <int Sides>
Weights weights_of(const Simplex& corners) {
  Eigen::Matrix<double, 3, Sides> sides;
  for (int k = 0; k < Sides; ++k) sides.col(k) = corners[static_cast<std::size_t>(k) + 1].at - corners[0].at;
  const Eigen::Matrix<double, Sides, Sides> square = sides.transpose() * sides;
  const Eigen::Matrix<double, Sides, 1> x = square.fullPivLu().solve(-(sides.transpose() * corners[0].at));
  Weights weights = {1};
  for (int k = 0; k < Sides; ++k) weights.push_back(x[k]), weights[0] -= x[k];
  return weights;
}

// Among all parts of the simplex, the one whose nearest point lies inside it and is nearest to the origin. `touching`:
// m², the square of a distance that counts as none.
NearestPart nearest_of(const Simplex& simplex, double touching) {
  NearestPart best;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned chosen = 1; chosen < 1u << simplex.size(); ++chosen) {
    Simplex corners;
    for (std::size_t i = 0; i < simplex.size(); ++i) {
      if (chosen >> i & 1) corners.push_back(simplex[i]);
    }
    const Weights weights = corners.size() == 1   ? Weights{1}
                            : corners.size() == 2 ? weights_of<1>(corners)
                            : corners.size() == 3 ? weights_of<2>(corners)
                                                  : weights_of<3>(corners);
    if (!std::all_of(weights.begin(), weights.end(), [](double weight) { return weight >= 0; })) continue;
    Vec3 at = Vec3::Zero();
    for (std::size_t k = 0; k < corners.size(); ++k) at += weights[k] * corners[k].at;
    // A tetrahedron that holds the origin has no distance from it. A flat one is a part too many: its triangles tell.
    if (corners.size() == 4 && at.squaredNorm() > touching) continue;
    if (at.squaredNorm() < least) least = at.squaredNorm(), best = {corners, weights, at};
  }
  return best;
}

ConvexGap from_weights(const NearestPart& nearest) {
  Vec3 of_a = Vec3::Zero(), of_b = Vec3::Zero();
  for (std::size_t k = 0; k < nearest.corners.size(); ++k) {
    of_a += nearest.weights[k] * nearest.corners[k].of_a, of_b += nearest.weights[k] * nearest.corners[k].of_b;
  }
  const double gap = nearest.at.norm();
  return {gap, nearest.at / gap, 0.5 * (of_a + of_b)};
}

// A triangle of the polytope, its plane, and its outward normal.
struct Triangle {
  std::array<std::size_t, 3> corners;
  Vec3 normal;
  double offset;  // m, of the plane from the origin
};

class Polytope {
 public:
  Polytope(const ConvexPair& pair, const Simplex& tetrahedron)
      : pair_(pair), points_(tetrahedron.begin(), tetrahedron.end()) {
    middle_ = (points_[0].at + points_[1].at + points_[2].at + points_[3].at) / 4;
    for (const std::array<std::size_t, 3>& corners :
         {std::array<std::size_t, 3>{0, 1, 2}, {0, 1, 3}, {0, 2, 3}, {1, 2, 3}})
      add(corners);
  }

  // Along any direction the shapes can be parted by their supports' distance. The least of all that were tried is the
  // answer, because the normals of slivers are rounding, and so are their distances from the origin.
  ConvexGap expand() {
    ConvexGap best{};
    double least = std::numeric_limits<double>::infinity(), reached = -least;  // m: supports, triangles
    for (int round = 0; round < kMostDistanceRounds; ++round) {
      const Triangle nearest = *std::min_element(triangles_.begin(), triangles_.end(),
                                                 [](const auto& x, const auto& y) { return x.offset < y.offset; });
      const Difference further = pair_.furthest(nearest.normal);
      const double depth = further.at.dot(nearest.normal);
      if (depth < least) least = depth, best = answer(nearest, depth);
      const bool is_sliver = nearest.offset < reached - kTouch * pair_.size();
      if (least - nearest.offset <= kDistanceConverged * pair_.size() || is_sliver || !grow(further)) break;
      reached = nearest.offset;
    }
    return best;
  }

 private:
  bool add(const std::array<std::size_t, 3>& corners) {
    const Vec3 &p = points_[corners[0]].at, &q = points_[corners[1]].at, &r = points_[corners[2]].at;
    const Vec3 across = (q - p).cross(r - p);
    const double area = across.norm();
    if (!(area > 1e-16 * pair_.size() * pair_.size())) return false;
    Triangle triangle{corners, across / area, 0};
    triangle.offset = triangle.normal.dot(p);
    if (triangle.normal.dot(middle_) > triangle.offset) triangle.normal *= -1, triangle.offset *= -1;
    triangles_.push_back(triangle);
    return true;
  }

  // Replaces the triangles that the point sees by those that join it to their border.
  bool grow(const Difference& point) {
    std::vector<std::array<std::size_t, 2>> border;
    std::vector<Triangle> kept;
    for (const Triangle& triangle : triangles_) {
      // A triangle in whose plane the point lies is replaced, too: else slivers would be made.
      if (triangle.normal.dot(point.at) <= triangle.offset - 0.1 * kDistanceConverged * pair_.size()) {
        kept.push_back(triangle);
        continue;
      }
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t from = std::min(triangle.corners[k], triangle.corners[(k + 1) % 3]),
                          to = std::max(triangle.corners[k], triangle.corners[(k + 1) % 3]);
        const auto shared = std::find(border.begin(), border.end(), std::array<std::size_t, 2>{from, to});
        if (shared == border.end())
          border.push_back({from, to});
        else
          border.erase(shared);
      }
    }
    if (border.empty()) return false;
    triangles_.swap(kept);
    points_.push_back(point);
    bool all = true;
    for (const auto& [from, to] : border) all &= add({from, to, points_.size() - 1});
    return all;
  }

  ConvexGap answer(const Triangle& triangle, double depth) const {
    const Vec3 foot = triangle.offset * triangle.normal;
    Mat3 corners;
    for (std::size_t k = 0; k < 3; ++k)
      corners.col(static_cast<Eigen::Index>(k)) = points_[triangle.corners[k]].at - foot;
    // The weights of the foot: the null vector of the corners relative to it, with the sum 1.
    const Vec3 u = corners.col(1) - corners.col(0), v = corners.col(2) - corners.col(0), w = -corners.col(0);
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), determinant = uu * vv - uv * uv;
    const double s = (vv * w.dot(u) - uv * w.dot(v)) / determinant, t = (uu * w.dot(v) - uv * w.dot(u)) / determinant;
    const Difference &p = points_[triangle.corners[0]], &q = points_[triangle.corners[1]],
                     &r = points_[triangle.corners[2]];
    const Vec3 of_a = (1 - s - t) * p.of_a + s * q.of_a + t * r.of_a,
               of_b = (1 - s - t) * p.of_b + s * q.of_b + t * r.of_b;
    return {-depth, -triangle.normal, 0.5 * (of_a + of_b)};
  }

  const ConvexPair& pair_;
  std::vector<Difference> points_;
  Vec3 middle_;
  std::vector<Triangle> triangles_;
};

// Adds corners to a simplex until it is a tetrahedron, each as far from the others' point, line or plane as it can be.
Simplex completed(Simplex simplex, const ConvexPair& pair) {
  while (simplex.size() < 4) {
    const Vec3 &origin = simplex[0].at, side = simplex.size() > 1 ? Vec3(simplex[1].at - origin) : Vec3::Zero();
    const auto beyond = [&](const Difference& point) {
      const Vec3 line = point.at - origin;
      if (simplex.size() == 1) return line.norm();
      if (simplex.size() == 2) return side.normalized().cross(line).norm();
      return std::abs(side.cross(simplex[2].at - origin).normalized().dot(line));
    };
    Difference best = simplex[0];
    for (int k = 0; k < 27; ++k) {
      const Vec3 n(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      if (n.isZero(0)) continue;
      const Difference point = pair.furthest(n);
      if (beyond(point) > beyond(best)) best = point;
    }
    simplex.push_back(best);
  }
  return simplex;
}

}  // namespace

ConvexGap convex_distance(const Shape& a, const Pose& pose_a, const Shape& b, const Pose& pose_b) {
  const ConvexPair pair(a, pose_a, b, pose_b);
  const double touching = kDistanceConverged * pair.size() * pair.size();
  Simplex simplex = {pair.furthest(-pair.between())};
  for (int round = 0; round < kMostDistanceRounds; ++round) {
    const NearestPart nearest = nearest_of(simplex, touching);
    const double square = nearest.at.squaredNorm();
    if (nearest.corners.size() == 4) return Polytope(pair, nearest.corners).expand();
    // The origin lies on a part of the simplex: the shapes touch, or overlap in a special way.
    if (square <= kTouch * kTouch * pair.size() * pair.size())
      return Polytope(pair, completed(nearest.corners, pair)).expand();
    const Difference further = pair.furthest(-nearest.at);
    if (square - nearest.at.dot(further.at) <= kDistanceConverged * square || round + 1 == kMostDistanceRounds)
      return from_weights(nearest);
    simplex = nearest.corners;
    simplex.push_back(further);
  }
  return {};
}

}  // namespace rigor::inline metric
