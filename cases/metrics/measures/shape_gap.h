// How far apart two bodies' surfaces are, from the scene's shapes and a pose alone: the judge's own geometry, shared
// with no engine. Negative: how deep they overlap, the shortest way that would part them.
#pragma once

#include <functional>

#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor {

// m. Exact for every pair of sphere, box, capsule and plane, but for two: boxes apart, where it is the widest gap along
// any axis of a face or across two edges, which is the distance unless two corners are nearest; and a capsule whose
// axis runs inside a box, where it is how deep the deepest point of it lies.
double shape_gap(const Shape& a, const BodyPose& pose_a, const Shape& b, const BodyPose& pose_b);

double bounding_radius(const Shape& shape);  // m, round the body's origin; infinite for a plane
double inradius(const Shape& shape);  // m, of the largest sphere inside: half its thickness; infinite for a plane

// Calls `visit(a, b, gap)` for each pair of the scene's colliding bodies, of which one can move, that may be nearer to
// each other than `distance` [m]: neighbours are found by sorting along one axis.
void for_each_near_pair(const Scene& scene, BodyColumns bodies, double distance,
                        const std::function<void(int a, int b, double gap)>& visit);

}  // namespace rigor
