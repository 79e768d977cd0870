#include "core/scene/toml/body_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "core/base/unit_vector.h"
#include "core/scene/toml/row_fault.h"

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
    std::copy_if(row.keys.begin(), row.keys.end(), std::back_inserter(keys), [&](const std::string& key) {
      return std::find(keys.begin(), keys.end(), key) == keys.end();
    });
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

void read_pose(const TableReader& row, bool is_plane, Body& body) {
  if (const auto value = row.find("position")) body.position = value->vector();
  if (const auto value = row.find("orientation_wxyz")) {
    if (is_plane) value->refuse("a plane lies as its normal says and has no orientation");
    body.orientation = read_orientation(*value);
  }
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
  body.name = row.at("name").text();
  refuse_if(fault_of_name(body.name), row);
  if (const auto shape = row.find("shape")) body.shape = read_shape(*shape);
  const bool is_plane = body.shape && std::holds_alternative<Plane>(*body.shape);
  body.fixed = read_fixed(row, is_plane);
  const auto collides = row.find("collides");
  body.collides = collides ? collides->flag() : body.shape.has_value();
  if (!body.fixed || row.find("mass")) body.mass = row.at("mass").positive();
  if (!body.fixed || row.find("inertia")) body.inertia = read_inertia(row, body);
  read_pose(row, is_plane, body);
  if (const auto value = row.find("velocity")) body.velocity = value->vector();
  if (const auto value = row.find("angular_velocity")) body.angular_velocity = value->vector();
  refuse_if(fault_of(body), row);
  return body;
}

}  // namespace rigor
