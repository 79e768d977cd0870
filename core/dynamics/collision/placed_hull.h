// A convex polyhedron in another frame than its own: a hull, or a box.
#pragma once

#include <vector>

#include "core/dynamics/collision/narrow_phase.h"

namespace rigor {

// The vectors keep their memory from one placing to the next.
struct PlacedHull {
  const Hull* hull = nullptr;
  double inradius = 0;  // m
  Vec3 centre;          // m
  std::vector<Vec3> points, normals;
  std::vector<double> offsets;
  // By face, of the pair that is looked at: the other's point that lies deepest behind it, or -1 where it is not known;
  // and a bound of the separation along the face's normal, m.
  std::vector<int> deepest;
  std::vector<double> bounds;

  void place(const Convex& convex, const Pose& pose) { place(*convex.hull, Vec3::Ones(), convex.hull->inradius, pose); }
  void place(const Box& box, const Pose& pose);

  Vec3 edge(const Hull::Edge& of) const { return points[index(of.to)] - points[index(of.from)]; }
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

 private:
  // Only a cube is stretched; that leaves its normals as they are.
  void place(const Hull& of, const Vec3& stretch, double its_inradius, const Pose& pose);
};

}  // namespace rigor
