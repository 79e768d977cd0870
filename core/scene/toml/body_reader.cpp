#include "core/scene/toml/body_reader.h"

#include <fmt/format.h>

#include "core/scene/toml/row_fault.h"
#include "core/scene/toml/shape_reader.h"

namespace rigor::inline scene {
namespace {

// Rows and columns xx, yy, zz, xy, xz, yz of the matrix itself, so that xy is minus the product of inertia.
Mat3 matrix_of_six(const std::vector<double>& v) {
  Mat3 m;
  m << v[0], v[3], v[4], v[3], v[1], v[5], v[4], v[5], v[2];
  return m;
}

// The inertia that a shape gives is about the centre of mass, which is the origin of B.
void refuse_off_centre(const TomlValue& value, const Shape& shape) {
  if (std::holds_alternative<Plane>(shape)) return;
  constexpr double kRounded = 1e-6;  // of the bounding radius: coordinates may have been written with six digits
  const Vec3 centre = centre_of(shape);
  if (centre.norm() <= kRounded * bounding_radius(shape)) return;
  value.refuse(
      fmt::format("found the centre of mass at [{:.9g}, {:.9g}, {:.9g}] m in the body's frame; allowed: at its origin. "
                  "Move the shapes by the opposite, or give the inertia",
                  centre.x(), centre.y(), centre.z()));
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
  const TomlValue shape = row.at(row.find("shape") ? "shape" : "shapes");
  refuse_off_centre(shape, *body.shape);
  const Mat3 inertia = inertia_of(*body.shape, body.mass);
  if (const auto why = why_no_inertia(inertia); !why.empty()) {
    shape.refuse(fmt::format("no inertia can be taken from this shape: {}", why));
  }
  return inertia;
}

bool read_fixed(const TableReader& row, const Body& body) {
  const auto value = row.find("fixed");
  const bool stands = body.shape && stands_still(*body.shape);
  if (!value) return stands;
  const bool fixed = value->flag();
  if (stands && !fixed)
    value->refuse(
        fmt::format("found false, but a {} never moves; allowed: true, or no such key", shape_name(*body.shape)));
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
      "name",  "mass",   "inertia",  "position", "orientation_wxyz", "velocity", "angular_velocity",
      "shape", "shapes", "collides", "fixed"};
  return keys;
}

Body read_body(const TableReader& row) {
  Body body;
  body.name = row.at("name").text();
  refuse_if(fault_of_name(body.name), row);
  body.shape = read_shapes(row);
  const bool is_plane = body.shape && std::holds_alternative<Plane>(*body.shape);
  body.fixed = read_fixed(row, body);
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

}  // namespace rigor::inline scene
