#include "core/dynamics/collision/placed_hull.h"

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

}  // namespace

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
