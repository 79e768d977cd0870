// Meshes of robots' files: each collides as its convex hull.
#pragma once

#include <optional>

#include "cases/import/xml.h"

namespace rigor::inline imports {

// The hull of a mesh's points, each multiplied by `scale`. Adds to left_out a mesh that is not found in its package,
// that is flat, or whose format has no reader. `element` names `path`; `model` is the robot's file. Throws InputError
// for a path that leaves the model's folder, and for a file that is missing or broken.
std::optional<Shape> hull_of_mesh(const std::string& path, const Vec3& scale, const XmlElement& element,
                                  const std::string& model, LeftOut& left_out);

// The hull of points; of many a smaller one inside it, as left_out then says. Nothing for points in one plane.
std::optional<Shape> hull_shape(const std::vector<Vec3>& points, const std::string& where, LeftOut& left_out);

// The points of a COLLADA file (.dae) in m, where its scene has them.
std::vector<Vec3> points_of_collada(const std::string& path);

}  // namespace rigor::inline imports
