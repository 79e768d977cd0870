#include "core/scene/toml/shape_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/base/error.h"
#include "core/base/unit_vector.h"
#include "core/scene/shapes/mesh_file.h"
#include "core/scene/toml/file_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor::inline scene {
namespace {

bool is_written(const ShapeInfo& info) { return !std::holds_alternative<Compound>(info.prototype); }

// The keys of a shape in a case file.
Keys keys_of(const ShapeInfo& info) {
  Keys keys = {"type"};
  keys.insert(keys.end(), info.keys.begin(), info.keys.end());
  if (std::holds_alternative<Convex>(info.prototype)) keys.insert(keys.end(), {"points", "file", "scale"});
  if (std::holds_alternative<Mesh>(info.prototype)) keys.insert(keys.end(), {"points", "triangles", "file", "scale"});
  if (std::holds_alternative<Heightfield>(info.prototype)) keys.insert(keys.end(), {"size", "heights"});
  if (info.is_solid) keys.insert(keys.end(), {"position", "orientation_wxyz"});
  return keys;
}

void read_field(const TomlValue& value, ShapeQuantity quantity, double& out) {
  out = quantity == ShapeQuantity::length ? value.positive() : value.number();
}

void read_field(const TomlValue& value, ShapeQuantity quantity, Vec3& out) {
  out = quantity == ShapeQuantity::direction ? value.direction() : value.vector();
  if (quantity == ShapeQuantity::lengths && out.minCoeff() <= 0)
    value.refuse("found a length that is not greater than 0; allowed: three lengths in m");
}

// What `make` makes of it, with the place of `given` in its errors.
template <typename Make>
auto made_of(const TomlValue& given, const Make& make) {
  try {
    return make();
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.starts_with(given.path() + ":")) throw;  // it has its place
    given.refuse(what);
  }
}

Corners read_corners(const TomlValue& value) {
  Corners corners;
  const std::vector<double> numbers = value.numbers({3});
  for (std::size_t k = 0; k < 3; ++k) {
    if (numbers[k] != std::floor(numbers[k]) || numbers[k] < 0 || numbers[k] > 1e9)
      value.refuse(fmt::format("found {}; allowed: three whole numbers, of points from 0 on", numbers[k]));
    corners[k] = static_cast<int>(numbers[k]);
  }
  return corners;
}

// From a file, or from the keys of the table itself. A hull needs no triangles.
MeshFile read_triangles(const TableReader& table, const std::string& shape, bool needs_triangles) {
  const auto file = table.find("file"), points = table.find("points"), scale = table.find("scale");
  if (file && points)
    points->refuse(fmt::format("a {} has either points or a file; allowed: one of these keys", shape));
  if (scale && !file) scale->refuse("only the points of a file are scaled; allowed: with the key file");
  MeshFile mesh;
  if (file) {
    mesh = parse_mesh(read_text_file(path_beside(file->path(), file->text())), file->text());
    const double factor = scale ? scale->positive() : 1;
    for (Vec3& point : mesh.points) point *= factor;
    return mesh;
  }
  for (const TomlValue& point : table.at("points").items()) mesh.points.push_back(point.vector());
  if (!needs_triangles) return mesh;
  for (const TomlValue& corners : table.at("triangles").items()) mesh.triangles.push_back(read_corners(corners));
  return mesh;
}

TomlValue triangles_given(const TableReader& table) { return table.at(table.find("file") ? "file" : "points"); }

Convex read_convex(const TableReader& table) {
  const TomlValue given = triangles_given(table);
  return made_of(given, [&] { return Convex{hull_of(read_triangles(table, "hull", false).points)}; });
}

Mesh read_mesh(const TableReader& table) {
  const TomlValue given = triangles_given(table);
  return made_of(given, [&] {
    const MeshFile mesh = read_triangles(table, "mesh", true);
    return Mesh{{closed_surface(mesh.points, mesh.triangles)}};
  });
}

Heightfield read_heightfield(const TableReader& table) {
  Heightfield field;
  const std::vector<double> size = table.at("size").numbers({2});
  if (!(std::min(size[0], size[1]) > 0))
    table.at("size").refuse("found a length that is not greater than 0; allowed: two lengths in m");
  field.size = {size[0], size[1]};
  const TomlValue heights = table.at("heights");
  for (const TomlValue& row : heights.items()) {
    if (!row.is_array()) row.refuse_found("a row of heights in m, [0, 0.1, …]");
    field.heights.push_back(row.numbers({row.items().size()}));
  }
  field.surface = made_of(heights, [&] { return height_surface(field.size, field.heights); });
  return field;
}

PlacedShape read_placed(const TomlValue& value) {
  Keys names, all = {"type"};
  for (const ShapeInfo& info : shape_types()) {
    if (!is_written(info)) continue;
    names.push_back(info.word);
    const Keys keys = keys_of(info);
    std::copy_if(keys.begin(), keys.end(), std::back_inserter(all),
                 [&](const std::string& key) { return std::find(all.begin(), all.end(), key) == all.end(); });
  }
  TableReader table = value.table(all);
  const std::string type = table.at("type").choice(names);
  const auto info =
      std::find_if(shape_types().begin(), shape_types().end(), [&](const ShapeInfo& row) { return row.word == type; });
  table.narrow(keys_of(*info), fmt::format("{} {}", type == "ellipsoid" ? "an" : "a", type));
  PlacedShape placed = {info->prototype, {}};
  if (auto* convex = std::get_if<Convex>(&placed.shape)) *convex = read_convex(table);
  if (auto* mesh = std::get_if<Mesh>(&placed.shape)) *mesh = read_mesh(table);
  if (auto* field = std::get_if<Heightfield>(&placed.shape)) *field = read_heightfield(table);
  for_each_field(placed.shape, [&](const char* key, ShapeQuantity quantity, auto& field) {
    read_field(table.at(key), quantity, field);
  });
  if (!info->is_solid) return placed;
  if (const auto position = table.find("position")) placed.pose.position = position->vector();
  if (const auto turn = table.find("orientation_wxyz")) placed.pose.orientation = read_orientation(*turn);
  return placed;
}

bool is_centred(const PlacedShape& placed) {
  return placed.pose.position.isZero(0) && placed.pose.orientation.vec().isZero(0);
}

}  // namespace

Quat read_orientation(const TomlValue& value) {
  const auto q = value.numbers({4});
  const auto unit = unit_vector(Eigen::Vector4d(q[0], q[1], q[2], q[3]));
  if (!unit) value.refuse("found the zero quaternion, which is no rotation; allowed: [w, x, y, z] of any other length");
  return {(*unit)[0], (*unit)[1], (*unit)[2], (*unit)[3]};
}

std::optional<Shape> read_shapes(const TableReader& row) {
  const auto one = row.find("shape"), several = row.find("shapes");
  if (one && several) several->refuse("the body has the key shape, too; allowed: one of the two");
  if (!one && !several) return {};
  if (several && !several->is_array()) several->refuse_found("an array of tables, [{ type = … }, …]");
  Compound compound;
  for (const TomlValue& value : several ? several->items() : std::vector<TomlValue>{*one}) {
    compound.parts.push_back(read_placed(value));
    if (const Shape& shape = compound.parts.back().shape; several && stands_still(shape))
      value.refuse(fmt::format("a {} cannot be one of several shapes; allowed: shape = {{ … }}", shape_name(shape)));
  }
  if (compound.parts.size() == 1 && is_centred(compound.parts[0])) return compound.parts[0].shape;
  return compound;
}

}  // namespace rigor::inline scene
