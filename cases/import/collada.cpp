// COLLADA 1.4 and 1.5: the positions of each mesh, moved by the nodes of the scene that show it. As in ROS, the axis
// that is up is not turned. Material, light and animation are not read.
#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "cases/import/mesh_shape.h"
#include "core/base/error.h"

namespace rigor::inline imports {
namespace {

using Affine = Eigen::Transform<double, 3, Eigen::Affine>;

class ColladaReader {
 public:
  explicit ColladaReader(const XmlFile& file) : root_(file.root()) {}

  std::vector<Vec3> points() {
    if (root_.name() != "COLLADA") root_.refuse("found this at the top; allowed: <COLLADA>");
    double unit = 1;
    if (const auto asset = root_.child("asset")) {
      if (const auto element = asset->child("unit")) unit = element->find_number("meter").value_or(1);
    }
    if (!(unit > 0)) root_.refuse("its unit is not greater than 0 m");
    for (const XmlElement& library : root_.children("library_geometries")) {
      for (const XmlElement& geometry : library.children("geometry")) read_geometry(geometry);
    }
    for (const char* name : {"library_nodes", "library_visual_scenes"}) {
      for (const XmlElement& library : root_.children(name)) keep_nodes(library, 0);
    }
    const std::vector<XmlElement> libraries = root_.children("library_visual_scenes");
    for (const XmlElement& library : libraries) {
      for (const XmlElement& scene : library.children("visual_scene")) {
        for (const XmlElement& node : scene.children("node")) add_node(node, Affine::Identity(), 0);
      }
    }
    if (libraries.empty()) {
      for (const auto& [id, points] : geometries_) points_.insert(points_.end(), points.begin(), points.end());
    }
    if (points_.empty()) root_.refuse("there is no mesh in its scene");
    for (Vec3& point : points_) point *= unit;
    return std::move(points_);
  }

 private:
  static constexpr int kDeepest = 50;
  static constexpr std::size_t kMostPoints = 1'000'000;

  static std::vector<double> numbers_in(const XmlElement& element) {
    const std::string text = element.text();
    std::vector<double> numbers;
    const char* at = text.c_str();
    for (char* end = nullptr;; at = end) {
      const double value = std::strtod(at, &end);
      if (end == at) break;
      if (!std::isfinite(value)) element.refuse("holds a number that is not finite");
      numbers.push_back(value);
      if (numbers.size() > 3 * kMostPoints) element.refuse(fmt::format("has more than {} points", kMostPoints));
    }
    if (*at != '\0') element.refuse(fmt::format("found '{}'; allowed: numbers", std::string(at).substr(0, 20)));
    return numbers;
  }

  std::vector<double> few_numbers(const XmlElement& element, std::size_t count) {
    const std::vector<double> numbers = numbers_in(element);
    if (numbers.size() != count) element.refuse(fmt::format("found {} numbers; allowed: {}", numbers.size(), count));
    return numbers;
  }

  void read_geometry(const XmlElement& geometry) {
    const auto mesh = geometry.child("mesh");
    if (!mesh) return;
    std::vector<Vec3>& points = geometries_[geometry.find("id").value_or("")];
    for (const XmlElement& vertices : mesh->children("vertices")) {
      for (const XmlElement& input : vertices.children("input")) {
        if (input.find("semantic").value_or("") != "POSITION") continue;
        const std::string source = input.at("source");
        for (const XmlElement& candidate : mesh->children("source")) {
          if ("#" + candidate.find("id").value_or("") == source) add_source(candidate, points);
        }
      }
    }
  }

  static void add_source(const XmlElement& source, std::vector<Vec3>& points) {
    const std::vector<double> numbers = numbers_in(source.only("float_array"));
    std::size_t stride = 3;
    if (const auto technique = source.child("technique_common")) {
      if (const auto accessor = technique->child("accessor"))
        stride = static_cast<std::size_t>(accessor->find_number("stride").value_or(3));
    }
    if (stride < 3 || stride > 16) source.refuse(fmt::format("its stride is {}; allowed: 3 to 16", stride));
    for (std::size_t i = 0; i + stride <= numbers.size(); i += stride)
      points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  }

  void keep_nodes(const XmlElement& above, int depth) {
    if (depth > kDeepest) above.refuse(fmt::format("its nodes are nested deeper than {}", kDeepest));
    for (const XmlElement& child : above.children()) {
      if (child.name() == "node") nodes_.emplace("#" + child.find("id").value_or(""), child);
      if (child.name() == "node" || child.name() == "visual_scene") keep_nodes(child, depth + 1);
    }
  }

  Affine motion_of(const XmlElement& element) {
    Affine motion = Affine::Identity();
    const std::string word = element.name();
    if (word == "matrix") {
      const std::vector<double> m = few_numbers(element, 16);
      for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 4; ++column) motion(row, column) = m[static_cast<std::size_t>(4 * row + column)];
      }
    } else if (word == "translate" || word == "scale") {
      const std::vector<double> v = few_numbers(element, 3);
      if (word == "translate") motion.translate(Vec3(v[0], v[1], v[2]));
      if (word == "scale") motion.scale(Vec3(v[0], v[1], v[2]));
    } else if (word == "rotate") {
      const std::vector<double> v = few_numbers(element, 4);
      const Vec3 axis(v[0], v[1], v[2]);
      if (axis.norm() > 0) motion.rotate(Eigen::AngleAxisd(v[3] * std::numbers::pi / 180, axis.normalized()));
    } else if (word == "lookat" || word == "skew") {
      element.refuse("is not read; allowed: matrix, rotate, scale, translate");
    }
    return motion;
  }

  void add_node(const XmlElement& node, Affine motion, int depth) {
    if (depth > kDeepest) node.refuse(fmt::format("its nodes are nested deeper than {}", kDeepest));
    for (const XmlElement& child : node.children()) motion = motion * motion_of(child);
    for (const XmlElement& shown : node.children("instance_geometry")) add_geometry(shown, motion);
    for (const XmlElement& other : node.children("instance_node")) {
      const auto found = nodes_.find(other.at("url"));
      if (found == nodes_.end()) other.refuse(fmt::format("there is no node '{}'", other.at("url")));
      add_node(found->second, motion, depth + 1);
    }
    for (const XmlElement& child : node.children("node")) add_node(child, motion, depth + 1);
  }

  void add_geometry(const XmlElement& shown, const Affine& motion) {
    const std::string url = shown.at("url");
    const auto found = geometries_.find(url.substr(std::min<std::size_t>(1, url.size())));
    if (found == geometries_.end()) shown.refuse(fmt::format("there is no geometry '{}'", url));
    for (const Vec3& point : found->second) points_.push_back(motion * point);
    if (points_.size() > kMostPoints)
      shown.refuse(fmt::format("with it the scene has more than {} points", kMostPoints));
  }

  XmlElement root_;
  std::map<std::string, std::vector<Vec3>> geometries_;
  std::map<std::string, XmlElement> nodes_;
  std::vector<Vec3> points_;
};

}  // namespace

std::vector<Vec3> points_of_collada(const std::string& path) {
  const XmlFile file(path);
  return ColladaReader(file).points();
}

}  // namespace rigor::inline imports
