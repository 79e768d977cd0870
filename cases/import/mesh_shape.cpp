#include "cases/import/mesh_shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>

#include "cases/import/model_files.h"
#include "core/base/error.h"
#include "core/scene/shapes/mesh_file.h"
#include "core/scene/toml/file_reader.h"

namespace rigor::inline imports {
namespace {

constexpr std::size_t kMostHullCorners = 500;  // more cost time in each step, and differ by less than a printer's layer

// Directions spread evenly over the sphere, by the golden angle.
std::vector<Vec3> even_directions(int count) {
  const double golden = kPi * (3 - std::sqrt(5.0));
  std::vector<Vec3> all;
  for (int i = 0; i < count; ++i) {
    const double z = 1 - (2.0 * i + 1) / count, across = std::sqrt(1 - z * z);
    all.emplace_back(across * std::cos(golden * i), across * std::sin(golden * i), z);
  }
  return all;
}

// The points that are furthest in some direction.
std::vector<Vec3> outermost(const std::vector<Vec3>& points) {
  std::set<std::size_t> chosen;
  for (const Vec3& n : even_directions(static_cast<int>(kMostHullCorners))) {
    std::size_t furthest = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      if (n.dot(points[i]) > n.dot(points[furthest])) furthest = i;
    }
    chosen.insert(furthest);
  }
  std::vector<Vec3> all;
  for (const std::size_t i : chosen) all.push_back(points[i]);
  return all;
}

// How far the points reach out of the hull, m.
double reach_beyond(const Hull& hull, const std::vector<Vec3>& points) {
  double most = 0;
  for (const Vec3& point : points) {
    for (const Hull::Face& face : hull.faces) most = std::max(most, face.normal.dot(point) - face.offset);
  }
  return most;
}

bool are_flat(const std::vector<Vec3>& points) {
  Vec3 low = points.front(), high = low;
  for (const Vec3& point : points) low = low.cwiseMin(point), high = high.cwiseMax(point);
  Mat3 spread = Mat3::Zero();
  const Vec3 centre = (low + high) / 2;
  for (const Vec3& point : points) spread += (point - centre) * (point - centre).transpose();
  const double size = (high - low).norm();
  return points.size() < 4 || !(size > 0) ||
         spread.determinant() <= 1e-24 * std::pow(size * size * static_cast<double>(points.size()), 3);
}

std::vector<Vec3> points_of_file(const std::string& file, const XmlElement& element) {
  const std::string ending = std::filesystem::path(file).extension().string();
  std::string lower = ending;
  std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
  try {
    if (lower == ".dae") return points_of_collada(file);
    // parse_mesh() knows the format by small letters.
    return parse_mesh(read_text_file(file), std::filesystem::path(file).replace_extension(lower).string()).points;
  } catch (const InputError& error) {
    element.refuse(error.what());
  }
}

}  // namespace

std::optional<Shape> hull_shape(const std::vector<Vec3>& points, const std::string& where, LeftOut& left_out) {
  if (points.empty() || are_flat(points)) {
    left_out.add(where, "a flat mesh", lost("its points lie in one plane: nothing touches it"));
    return {};
  }
  const std::vector<Vec3> few = points.size() > kMostHullCorners ? outermost(points) : points;
  const auto hull = hull_of(few);
  if (const double beyond = few.size() < points.size() ? reach_beyond(*hull, points) : 0; beyond > 0)
    left_out.add(where, "a fine mesh",
                 assumed(fmt::format("its hull has its {} outermost corners, and is too small by at most {:.2g} mm",
                                     hull->points.size(), 1000 * beyond)));
  return Convex{hull};
}

// "ur_description" of "package://ur_description/meshes/base.stl".
static std::string package_of(const std::string& path) {
  const std::size_t scheme = path.find("://"), first = scheme == std::string::npos ? 0 : scheme + 3;
  return path.substr(first, path.find('/', first) - first);
}

std::optional<Shape> hull_of_mesh(const std::string& path, const Vec3& scale, const XmlElement& element,
                                  const std::string& model, LeftOut& left_out) {
  const std::optional<std::string> file = file_of_mesh(path, element, model);
  if (!file) {
    left_out.add(element.place(), "a mesh of another package",
                 lost(fmt::format("no folder above the model is the package '{}'", package_of(path))));
    return {};
  }
  std::vector<Vec3> points = points_of_file(*file, element);
  if (scale.cwiseAbs().minCoeff() == 0) element.refuse("scale: holds a zero; allowed: numbers other than 0");
  for (Vec3& point : points) point = point.cwiseProduct(scale);
  left_out.add(element.place(), "a mesh", assumed("collides as its convex hull"));
  return hull_shape(points, element.place(), left_out);
}

}  // namespace rigor::inline imports
