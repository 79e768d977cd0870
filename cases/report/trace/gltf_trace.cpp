// glTF 2.0 (registry.khronos.org/glTF): one file, its numbers as base64. A node a body, moved by an animation; below it
// its shape, of a few meshes of size one that are scaled. Up is +y there: the node of the world turns the scene's up,
// against gravity, to it. With contacts, each contact of a sample is a red bar from its point along the force on the
// second body. There are as many bars as a sample has contacts at most; those without a contact have no size.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numbers>

#include "cases/report/json/packing.h"
#include "cases/report/trace/trace_formats.h"
#include "core/base/json.h"
#include "core/base/rotation_between.h"

namespace rigor::inline report {
namespace {

enum Component { kUnsignedShort = 5123, kFloat = 5126 };
enum Target { kVertices = 34962, kIndices = 34963 };

// A square of edge 1 that looks along z.
TriangleMesh square() {
  return {{{-0.5, -0.5, 0}, {0.5, -0.5, 0}, {0.5, 0.5, 0}, {-0.5, 0.5, 0}},
          std::vector<Vec3>(4, Vec3::UnitZ()),
          {0, 1, 2, 0, 2, 3}};
}

enum MeshIndex { kCube, kTube, kBall, kSquare };

class GltfFile {
 public:
  GltfFile() {
    json_ = {{"asset", {{"version", "2.0"}, {"generator", "rigor"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    json_["nodes"] = Json::array();
    json_["materials"] = {material(0.25, 0.5, 0.85), material(0.6, 0.6, 0.6)};
    for (const int material : {0, 1}) {
      for (const TriangleMesh& mesh : {unit_cube(), unit_tube(), unit_ball(), square()}) add_mesh(mesh, material);
    }
  }

  int add_node(const Json& node) {
    json_["nodes"].push_back(node);
    return static_cast<int>(json_["nodes"].size()) - 1;
  }
  Json& node(int index) { return json_["nodes"][static_cast<std::size_t>(index)]; }

  // `count` rows of `width` floats.
  int add_floats(const std::vector<float>& values, int width, const Json& bounds = {}, int target = 0) {
    static const char* kTypes[] = {"", "SCALAR", "", "VEC3", "VEC4"};
    Json accessor = {{"bufferView", add_view(values.data(), values.size() * sizeof(float), target)},
                     {"componentType", kFloat},
                     {"count", values.size() / static_cast<std::size_t>(width)},
                     {"type", kTypes[width]}};
    accessor.update(bounds.is_null() ? Json::object() : bounds);
    return add_accessor(accessor);
  }

  void set_animation(const Json& channels, const Json& samplers) {
    json_["animations"] = {{{"name", "motion"}, {"channels", channels}, {"samplers", samplers}}};
  }

  std::string text() {
    json_["buffers"] = {
        {{"byteLength", bytes_.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes_)}}};
    return json_.dump() + "\n";
  }

  // Returns its number.
  int add_mesh(const TriangleMesh& mesh, int material) {
    std::vector<float> points, normals;
    Vec3 low = mesh.points.front(), high = low;
    for (std::size_t i = 0; i < mesh.points.size(); ++i) {
      low = low.cwiseMin(mesh.points[i]), high = high.cwiseMax(mesh.points[i]);
      for (int k = 0; k < 3; ++k)
        points.push_back(static_cast<float>(mesh.points[i][k])),
            normals.push_back(static_cast<float>(mesh.normals[i][k]));
    }
    const auto floats = [](const Vec3& v) {
      return Json{static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
    };
    const int position = add_floats(points, 3, {{"min", floats(low)}, {"max", floats(high)}}, kVertices),
              normal = add_floats(normals, 3, {}, kVertices);
    const std::vector<std::uint16_t> corners(mesh.corners.begin(), mesh.corners.end());
    const int indices = add_accessor({{"bufferView", add_view(corners.data(), 2 * corners.size(), kIndices)},
                                      {"componentType", kUnsignedShort},
                                      {"count", corners.size()},
                                      {"type", "SCALAR"}});
    json_["meshes"].push_back({{"primitives",
                                {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}}},
                                  {"indices", indices},
                                  {"material", material}}}}});
    return static_cast<int>(json_["meshes"].size()) - 1;
  }

  int add_red_tube() {
    json_["materials"].push_back(material(0.85, 0.2, 0.15));
    return add_mesh(unit_tube(), static_cast<int>(json_["materials"].size()) - 1);
  }

 private:
  static Json material(double r, double g, double b) {
    return {
        {"pbrMetallicRoughness", {{"baseColorFactor", {r, g, b, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.7}}},
        {"doubleSided", true}};
  }

  int add_view(const void* data, std::size_t size, int target) {
    while (bytes_.size() % 4 != 0) bytes_ += '\0';
    Json view = {{"buffer", 0}, {"byteOffset", bytes_.size()}, {"byteLength", size}};
    if (target != 0) view["target"] = target;
    bytes_.append(static_cast<const char*>(data), size);
    json_["bufferViews"].push_back(view);
    return static_cast<int>(json_["bufferViews"].size()) - 1;
  }
  int add_accessor(const Json& accessor) {
    json_["accessors"].push_back(accessor);
    return static_cast<int>(json_["accessors"].size()) - 1;
  }

  Json json_;
  std::string bytes_;
};

Json gltf_vector(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Json gltf_turn(const Quat& q) { return {q.x(), q.y(), q.z(), q.w()}; }

// The nodes of a shape, below that of its body.
struct ShapeNodes {
  GltfFile& file;
  int material;
  std::vector<int> nodes = {};
  BodyPose at = {};  // of the shape in B

  void add(MeshIndex mesh, const Vec3& scale, const BodyPose& pose = {}) {
    constexpr int kMeshes = 4;  // in each colour
    add_node(kMeshes * material + mesh, scale, pose);
  }
  void add_node(int mesh, const Vec3& scale, const BodyPose& pose) {
    const BodyPose in_B = at * pose;
    nodes.push_back(file.add_node({{"mesh", mesh},
                                   {"scale", gltf_vector(scale)},
                                   {"translation", gltf_vector(in_B.position)},
                                   {"rotation", gltf_turn(in_B.orientation)}}));
  }
  void operator()(const Sphere& sphere) { add(kBall, Vec3::Constant(2 * sphere.radius)); }
  void operator()(const Box& box) { add(kCube, box.size); }
  void operator()(const Capsule& capsule) {
    const double width = 2 * capsule.radius;
    add(kTube, {width, width, capsule.length});
    for (const double side : {-0.5, 0.5})
      add(kBall, Vec3::Constant(width), {side * capsule.length * Vec3::UnitZ(), Quat::Identity()});
  }
  void operator()(const Compound& compound) {
    for (const PlacedShape& part : compound.parts) {
      at = part.pose;
      std::visit([this](const auto& shape) { (*this)(shape); }, part.shape);
    }
    at = {};
  }
  void operator()(const Ellipsoid& ellipsoid) { add(kBall, 2 * ellipsoid.radii); }
  void operator()(const Plane& plane) { add(kSquare, Vec3::Constant(2 * kDrawnPlane), pose_of_plane(plane)); }
  template <typename Other>
  void operator()(const Other& other) {
    add_node(file.add_mesh(other.drawn(), material), Vec3::Ones(), {});
  }
};

class GltfTrace : public TraceWriter {
 public:
  GltfTrace(const Scene& scene, bool has_contacts)
      : scene_(scene),
        positions_(scene.bodies.size()),
        turns_(scene.bodies.size()),
        metres_per_newton_(has_contacts ? drawn_metres_per_newton(scene) : 0) {}

  std::string add(const Sample& sample) override {
    times_.push_back(static_cast<float>(sample.time));
    const BodyColumns bodies = sample.bodies.columns();
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const Vec3 p = bodies.position(i);
      Quat q = bodies.orientation(i).normalized();
      // The shorter way from one to the next is the one that is meant.
      if (!turns_[i].empty() &&
          q.coeffs().cast<float>().dot(Eigen::Map<const Eigen::Vector4f>(&turns_[i][turns_[i].size() - 4])) < 0)
        q.coeffs() = -q.coeffs();
      for (int k = 0; k < 3; ++k) positions_[i].push_back(static_cast<float>(p[k]));
      for (int k = 0; k < 4; ++k) turns_[i].push_back(static_cast<float>(q.coeffs()[k]));
    }
    contacts_.push_back(sample.contacts);
    return "";
  }

  std::string end() override {
    GltfFile file;
    const Vec3 up = scene_.gravity.isZero(0) ? Vec3::UnitY().eval() : Vec3(-scene_.gravity.normalized());
    const int world = file.add_node({{"name", "world"}, {"rotation", gltf_turn(rotation_between(up, Vec3::UnitY()))}});
    Json children = Json::array();
    const int input =
        times_.empty() ? -1 : file.add_floats(times_, 1, {{"min", {times_.front()}}, {"max", {times_.back()}}});
    GltfAnimation motion{input};
    for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
      const Body& body = scene_.bodies[i];
      ShapeNodes shape{file, body.fixed ? 1 : 0};
      std::visit([&](const auto& its) { shape(its); }, drawn_shape(body));
      const int node = file.add_node({{"name", body.name},
                                      {"translation", gltf_vector(body.position)},
                                      {"rotation", gltf_turn(body.orientation)},
                                      {"children", shape.nodes}});
      children.push_back(node);
      if (body.fixed || input < 0) continue;
      motion.animate(node, "translation", file.add_floats(positions_[i], 3), "LINEAR");
      motion.animate(node, "rotation", file.add_floats(turns_[i], 4), "LINEAR");
    }
    if (input >= 0) add_bars(file, motion, children);
    file.node(world)["children"] = children;
    if (!motion.channels.empty()) file.set_animation(motion.channels, motion.samplers);
    return file.text();
  }

 private:
  struct GltfAnimation {
    int input;  // the accessor of the times
    Json channels = Json::array(), samplers = Json::array();

    void animate(int node, const char* path, int output, const char* interpolation) {
      channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", node}, {"path", path}}}});
      samplers.push_back({{"input", input}, {"output", output}, {"interpolation", interpolation}});
    }
  };

  // One bar for the k-th contact of each sample. A force is a mean over the step that ends at its sample: it does not
  // go over into the next one.
  void add_bars(GltfFile& file, GltfAnimation& motion, Json& children) const {
    std::size_t most = 0;
    for (const auto& contacts : contacts_) most = std::max(most, contacts.size());
    const int mesh = most > 0 && metres_per_newton_ > 0 ? file.add_red_tube() : -1;
    for (std::size_t k = 0; mesh >= 0 && k < most; ++k) {
      std::vector<float> places, turns, sizes;
      for (const auto& contacts : contacts_)
        add_bar(k < contacts.size() ? &contacts[k] : nullptr, places, turns, sizes);
      const int node = file.add_node({{"name", "contact force " + std::to_string(k + 1)}, {"mesh", mesh}});
      children.push_back(node);
      motion.animate(node, "translation", file.add_floats(places, 3), "STEP");
      motion.animate(node, "rotation", file.add_floats(turns, 4), "STEP");
      motion.animate(node, "scale", file.add_floats(sizes, 3), "STEP");
    }
  }

  // The tube of length 1 lies along z about its middle.
  void add_bar(const ReportedContact* contact, std::vector<float>& places, std::vector<float>& turns,
               std::vector<float>& sizes) const {
    constexpr double kWidth = 0.08;  // of the bar's length
    const Vec3 bar = contact ? Vec3(metres_per_newton_ * contact->force) : Vec3::Zero().eval();
    const double length = bar.norm();
    const Quat turn = length > 0 ? rotation_between(Vec3::UnitZ(), bar / length) : Quat::Identity();
    const Vec3 middle = contact ? Vec3(contact->point + bar / 2) : Vec3::Zero().eval();
    const Vec3 size(kWidth * length, kWidth * length, length);
    for (int k = 0; k < 3; ++k) places.push_back(static_cast<float>(middle[k]));
    for (int k = 0; k < 4; ++k) turns.push_back(static_cast<float>(turn.coeffs()[k]));
    for (int k = 0; k < 3; ++k) sizes.push_back(static_cast<float>(size[k]));
  }

  const Scene& scene_;
  std::vector<float> times_;                           // s
  std::vector<std::vector<float>> positions_, turns_;  // by body: m; x, y, z, w
  double metres_per_newton_;
  std::vector<std::vector<ReportedContact>> contacts_;  // by sample
};

}  // namespace

std::unique_ptr<TraceWriter> gltf_trace(const Scene& scene, bool has_contacts) {
  return std::make_unique<GltfTrace>(scene, has_contacts);
}

}  // namespace rigor::inline report
