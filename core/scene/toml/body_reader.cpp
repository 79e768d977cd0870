#include "core/scene/toml/body_reader.h"

#include <fmt/format.h>

#include "core/base/unit_vector.h"
#include "core/scene/toml/table_reader.h"
#include "core/scene/validate.h"

namespace rigor {
namespace {

struct ShapeRow {
  std::string name;
  Keys keys;
  Shape (*read)(const TableReader& table);
};

const std::vector<ShapeRow>& shape_rows() {
  static const std::vector<ShapeRow> rows = {
      {"box",
       {"type", "size"},
       [](const TableReader& t) -> Shape {
         const TomlValue size = t.at("size");
         const Vec3 edges = size.vector();
         if (edges.minCoeff() <= 0)
           size.refuse("found an edge that is not greater than 0; allowed: three lengths in m");
         return Box{edges};
       }},
      {"capsule",
       {"type", "radius", "length"},
       [](const TableReader& t) -> Shape {
         return Capsule{t.at("radius").positive(), t.at("length").positive()};
       }},
      {"plane",
       {"type", "normal", "offset"},
       [](const TableReader& t) -> Shape {
         return Plane{t.at("normal").direction(), t.at("offset").number()};
       }},
      {"sphere", {"type", "radius"}, [](const TableReader& t) -> Shape { return Sphere{t.at("radius").positive()}; }},
  };
  return rows;
}

Shape read_shape(const TomlValue& value) {
  Keys names, keys = {"type"};
  for (const ShapeRow& row : shape_rows()) {
    names.push_back(row.name);
    keys.insert(keys.end(), row.keys.begin() + 1, row.keys.end());
  }
  TableReader table = value.table(keys);
  const std::string type = table.at("type").choice(names);
  for (const ShapeRow& row : shape_rows()) {
    if (row.name != type) continue;
    table.narrow(row.keys, fmt::format("a {}", type));
    return row.read(table);
  }
  table.at("type").refuse_found("a shape");  // not reached: the type is one of the names
}

// Rows and columns xx, yy, zz, xy, xz, yz of the matrix itself, so that xy is minus the product of inertia.
Mat3 matrix_of_six(const std::vector<double>& v) {
  Mat3 m;
  m << v[0], v[3], v[4], v[3], v[1], v[5], v[4], v[5], v[2];
  return m;
}

Mat3 read_inertia(const TableReader& row, const Body& body) {
  if (const auto value = row.find("inertia")) {
    const auto v = value->numbers({3, 6});
    const Mat3 inertia = v.size() == 3 ? Mat3(Vec3(v[0], v[1], v[2]).asDiagonal()) : matrix_of_six(v);
    if (const auto why = why_no_inertia(inertia); !why.empty()) {
      value->refuse(fmt::format("no body has this inertia: {}", why));
    }
    return inertia;
  }
  if (!body.shape)
    row.refuse(
        fmt::format("body '{}' can move and has neither an inertia nor a shape to take it from", shown(body.name)));
  const Mat3 inertia = inertia_of(*body.shape, body.mass);
  if (const auto why = why_no_inertia(inertia); !why.empty()) {
    row.at("shape").refuse(fmt::format("no inertia can be taken from this shape: {}", why));
  }
  return inertia;
}

std::string read_name(const TableReader& row) {
  const TomlValue value = row.at("name");
  const std::string name = value.text();
  if (name == "world") value.refuse("'world' is the name of the world itself; allowed: any other name");
  return name;
}

Quat read_orientation(const TomlValue& value) {
  const auto q = value.numbers({4});
  const auto unit = unit_vector(Eigen::Vector4d(q[0], q[1], q[2], q[3]));
  if (!unit) value.refuse("found the zero quaternion, which is no rotation; allowed: [w, x, y, z] of any other length");
  return {(*unit)[0], (*unit)[1], (*unit)[2], (*unit)[3]};
}

bool read_fixed(const TableReader& row, bool is_plane) {
  const auto value = row.find("fixed");
  if (!value) return is_plane;
  const bool fixed = value->flag();
  if (is_plane && !fixed) value->refuse("found false, but a plane never moves; allowed: true, or no such key");
  return fixed;
}

bool read_collides(const TableReader& row, bool has_shape) {
  const auto value = row.find("collides");
  if (!value) return has_shape;
  const bool collides = value->flag();
  if (collides && !has_shape) value->refuse("found true, but the body has no shape to collide with; allowed: false");
  return collides;
}

void read_pose(const TableReader& row, bool is_plane, Body& body) {
  if (const auto value = row.find("position")) {
    body.position = value->vector();
    if (is_plane && !body.position.isZero(0))
      value->refuse("a plane lies where its normal and offset say, not at a position");
  }
  if (const auto value = row.find("orientation_wxyz")) {
    if (is_plane) value->refuse("a plane lies as its normal says and has no orientation");
    body.orientation = read_orientation(*value);
  }
}

Vec3 read_rate(const TableReader& row, std::string_view key, bool fixed) {
  const auto value = row.find(key);
  if (!value) return Vec3::Zero();
  const Vec3 rate = value->vector();
  if (fixed && !rate.isZero(0)) value->refuse("a fixed body does not move; allowed: [0, 0, 0], or no such key");
  return rate;
}

}  // namespace

const std::vector<std::string>& body_keys() {
  static const Keys keys = {
      "name",  "mass",     "inertia", "position", "orientation_wxyz", "velocity", "angular_velocity",
      "shape", "collides", "fixed"};
  return keys;
}

Body read_body(const TableReader& row) {
  Body body;
  body.name = read_name(row);
  if (const auto shape = row.find("shape")) body.shape = read_shape(*shape);
  const bool is_plane = body.shape && std::holds_alternative<Plane>(*body.shape);
  body.fixed = read_fixed(row, is_plane);
  body.collides = read_collides(row, body.shape.has_value());
  if (!body.fixed || row.find("mass")) body.mass = row.at("mass").positive();
  if (!body.fixed || row.find("inertia")) body.inertia = read_inertia(row, body);
  read_pose(row, is_plane, body);
  body.velocity = read_rate(row, "velocity", body.fixed);
  body.angular_velocity = read_rate(row, "angular_velocity", body.fixed);
  return body;
}

}  // namespace rigor
