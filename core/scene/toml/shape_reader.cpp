#include "core/scene/toml/shape_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/base/error.h"
#include "core/base/unit_vector.h"
#include "core/scene/shapes/mesh_file.h"
#include "core/scene/toml/file_reader.h"
#include "core/scene/toml/pose_reader.h"
#include "core/scene/toml/table_reader.h"

namespace rigor {
namespace {

bool is_written(const ShapeInfo& info) { return !std::holds_alternative<Compound>(info.prototype); }

// The keys of a shape in a case file.
Keys keys_of(const ShapeInfo& info) {
  Keys keys = {"type"};
  keys.insert(keys.end(), info.keys.begin(), info.keys.end());
  if (std::holds_alternative<Convex>(info.prototype)) keys.insert(keys.end(), {"points", "file", "scale"});
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

std::vector<Vec3> points_of_file(const TomlValue& value, double scale) {
  const std::string path = path_beside(value.path(), value.text());
  std::vector<Vec3> points = parse_mesh(read_text_file(path), value.text()).points;
  for (Vec3& point : points) point *= scale;
  return points;
}

Convex read_convex(const TableReader& table) {
  const auto file = table.find("file"), points = table.find("points"), scale = table.find("scale");
  if (file && points) points->refuse("a hull has either points or a file; allowed: one of these keys");
  if (scale && !file) scale->refuse("only the points of a file are scaled; allowed: with the key file");
  const TomlValue given = file ? *file : table.at("points");
  try {
    if (file) return {hull_of(points_of_file(*file, scale ? scale->positive() : 1))};
    std::vector<Vec3> corners;
    for (const TomlValue& point : points->items()) corners.push_back(point.vector());
    return {hull_of(corners)};
  } catch (const InputError& error) {
    const std::string what = error.what();
    if (what.starts_with(given.path() + ":")) throw;  // it has its place
    given.refuse(what);
  }
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

std::optional<Shape> read_shapes(const TableReader& row) {
  const auto one = row.find("shape"), several = row.find("shapes");
  if (one && several) several->refuse("the body has the key shape, too; allowed: one of the two");
  if (!one && !several) return {};
  if (several && !several->is_array()) several->refuse_found("an array of tables, [{ type = … }, …]");
  Compound compound;
  for (const TomlValue& value : several ? several->items() : std::vector<TomlValue>{*one}) {
    compound.parts.push_back(read_placed(value));
    if (several && std::holds_alternative<Plane>(compound.parts.back().shape))
      value.refuse("a plane is given in W and cannot be one of several shapes; allowed: shape = { … }");
  }
  if (compound.parts.size() == 1 && is_centred(compound.parts[0])) return compound.parts[0].shape;
  return compound;
}

}  // namespace rigor
