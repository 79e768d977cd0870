// A convex polyhedron in another frame than its own: a hull, or a box.
#pragma once

#include <limits>
#include <vector>

#include "core/dynamics/collision/narrow_phase.h"

namespace rigor::inline dynamics {

// The vectors keep their memory from one placing to the next.
struct PlacedHull {
  const Hull* hull = nullptr;
  double inradius = 0;  // m
  Vec3 centre;          // m
  std::vector<Vec3> points, normals;
  std::vector<double> offsets;
  std::vector<int> deepest;    // by face: the other's point that lies deepest behind it, or -1 if that is not known
  std::vector<double> bounds;  // m, by face: at least the separation along its normal

  void place(const Convex& convex, const Pose& pose) { place(*convex.hull, Vec3::Ones(), convex.hull->inradius, pose); }
  void place(const Box& box, const Pose& pose);

  Vec3 edge(const Hull::Edge& of) const { return points[index(of.to)] - points[index(of.from)]; }
  static std::size_t index(int i) { return static_cast<std::size_t>(i); }

 private:
  // Only a cube is stretched; that leaves its normals as they are.
  void place(const Hull& of, const Vec3& stretch, double its_inradius, const Pose& pose);
};

// The face that looks most against n.
std::size_t facing_of(const PlacedHull& of, const Vec3& n);
// The same of the faces at a corner. Those of a sharp corner all look aside, and another face may look more against n.
std::size_t facing_at(const PlacedHull& of, int corner, const Vec3& n);

// The axis along which two polyhedra are separated most: a face normal, or the product of two edges whose arcs cross on
// the Gauss map (Gregorius, The Separating Axis Test between Convex Polyhedra, 2013). Most faces and edges need no
// look, for the other's inscribed ball bounds their separation. Nor does an edge if a point of the other lies deeper
// behind both of its faces than the best face axis found.
struct HullAxis {
  double separation = -std::numeric_limits<double>::infinity();
  Vec3 n = Vec3::Zero();  // unit, in W, from a to b
  int a = -1, b = -1;     // of a face axis: `a` is the face; of an edge axis: both edges
};

// Over the faces of `of`; n points out of it. The first of equal ones counts.
HullAxis best_face_of(PlacedHull& of, const PlacedHull& other);

// Over pairs of edges, after both calls of best_face_of(), that can separate more than `found` [m].
HullAxis best_edges_of(PlacedHull& a, PlacedHull& b, double found);

}  // namespace rigor::inline dynamics
