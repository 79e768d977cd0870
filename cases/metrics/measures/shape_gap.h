// The distance between two bodies' surfaces, from the scene's shapes and a pose alone. It is negative for an overlap,
// by the shortest way that would part them. No engine shares this geometry. Only on surfaces of triangles is the gap
// that of the core's points of contact.
#pragma once

#include <functional>

#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline metric {

// m. Exact for every pair of sphere, box, capsule and plane, with two exceptions. For separate boxes it is the largest
// gap along any face normal or across two edges, which is the distance unless two corners are nearest. For a capsule
// whose axis is inside a box it is the depth of its deepest point.
double shape_gap(const Shape& a, const BodyPose& pose_a, const Shape& b, const BodyPose& pose_b);

// Calls `visit(a, b, gap)` for each pair of the scene's colliding bodies, one of which can move, that may be nearer
// than `distance` [m]. Neighbours are found by sorting along one axis.
void for_each_near_pair(const Scene& scene, BodyColumns bodies, double distance,
                        const std::function<void(int a, int b, double gap)>& visit);

}  // namespace rigor::inline metric
