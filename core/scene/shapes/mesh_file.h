// Triangles from OBJ and STL files, the latter as text or binary.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/base/math.h"

namespace rigor::inline scene {

struct MeshFile {
  static constexpr std::size_t kMostTriangles = 1'000'000;

  std::vector<Vec3> points;                   // in the file's unit
  std::vector<std::array<int, 3>> triangles;  // numbers of points; a polygon of an OBJ file becomes a fan
};

// The extension of `name` tells the format: .obj or .stl. Throws InputError: "name:line: …", or "name: …" of a binary
// file.
MeshFile parse_mesh(const std::string& text, const std::string& name);

// The path of a file that a case file names beside itself. Throws InputError for one that leads out of that folder.
std::string path_beside(const std::string& case_file, const std::string& name);

}  // namespace rigor::inline scene
