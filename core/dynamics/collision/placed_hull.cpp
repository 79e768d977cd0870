#include "core/dynamics/collision/placed_hull.h"

#include <algorithm>

namespace rigor::inline dynamics {
namespace {

const Hull& unit_cube_hull() {
  static const std::shared_ptr<const Hull> cube = [] {
    std::vector<Vec3> corners;
    for (int k = 0; k < 8; ++k) corners.emplace_back(k & 1 ? 0.5 : -0.5, k & 2 ? 0.5 : -0.5, k & 4 ? 0.5 : -0.5);
    return hull_of(corners);
  }();
  return *cube;
}

bool has_corner(const Hull::Face& face, int corner) {
  return std::find(face.corners.begin(), face.corners.end(), corner) != face.corners.end();
}

template <typename Counts>
std::size_t facing_among(const PlacedHull& of, const Vec3& n, const Counts& counts) {
  std::size_t best = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t f = 0; f < of.normals.size(); ++f) {
    const double along = of.normals[f].dot(n);
    if (along < least && counts(f)) least = along, best = f;
  }
  return best;
}

}  // namespace

std::size_t facing_of(const PlacedHull& of, const Vec3& n) {
  return facing_among(of, n, [](std::size_t) { return true; });
}

std::size_t facing_at(const PlacedHull& of, int corner, const Vec3& n) {
  return facing_among(of, n, [&](std::size_t f) { return has_corner(of.hull->faces[f], corner); });
}

// The axes of a box may be mirrored, to number its corners as a mirror does. Corners of faces must run anticlockwise.
void PlacedHull::place(const Box& box, const Pose& pose) {
  Pose proper = pose;
  if (pose.R.determinant() < 0) proper.R.col(0) *= -1;
  place(unit_cube_hull(), box.size, box.inradius(), proper);
}

void PlacedHull::place(const Hull& of, const Vec3& stretch, double its_inradius, const Pose& pose) {
  hull = &of, inradius = its_inradius;
  centre = pose.p + pose.R * of.centre;
  points.resize(of.points.size()), normals.resize(of.faces.size()), offsets.resize(of.faces.size());
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = pose.p + pose.R * of.points[i].cwiseProduct(stretch);
  for (std::size_t f = 0; f < normals.size(); ++f) {
    const Hull::Face& face = of.faces[f];
    normals[f] = pose.R * face.normal;
    const double offset = stretch == Vec3::Ones() ? face.offset : face.normal.cwiseAbs().dot(0.5 * stretch);
    offsets[f] = offset + normals[f].dot(pose.p);
  }
}

}  // namespace rigor::inline dynamics
