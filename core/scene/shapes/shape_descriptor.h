// The descriptor of a shape: its word in case files and its fields. Each shape has one file in this folder, and one row
// in shape_types.h. Readers, writers, checks and exports work from the descriptor. A shape also has these functions, in
// its own frame:
//   volume()           m³
//   centre()           m: the centre of mass of even density
//   inertia(mass)      kg m², about that centre
//   bounding_radius()  m, about the origin of the shape's frame
//   inradius()         m: of a solid, the largest ball's about the origin; a motion by less cannot pass through it
//   support(n)         m: a point of the shape that lies furthest along n
//   drawn()            triangles of its surface
// Those of a plane, which fills half of space, have no use but inradius() and bounding_radius(): both are infinite.
#pragma once

#include <array>
#include <limits>
#include <variant>

#include "core/base/math.h"
#include "core/scene/shapes/triangle_mesh.h"

namespace rigor::inline scene {

inline constexpr double kPi = 3.14159265358979323846;  // std::numbers is C++20, and one engine's process is C++17

enum class ShapeQuantity { length, lengths, direction, number };  // m, > 0; m, each > 0; unit, in W; m

template <typename Type>
struct ShapeField {
  const char* key = nullptr;  // of case files and of JSON
  ShapeQuantity quantity = ShapeQuantity::length;
  std::variant<double Type::*, Vec3 Type::*> value = static_cast<double Type::*>(nullptr);
};

template <typename Type>
struct ShapeDescriptor {
  const char* word;                             // of case files, JSON and features ("contact:box-plane")
  const char* meaning;                          // one line of documentation
  std::array<ShapeField<Type>, 2> fields = {};  // the unused ones have no key

  // Calls visitor(key, quantity, value) for each field.
  template <typename Shape, typename Visitor>
  static void visit(Shape& shape, const Visitor& visitor) {
    constexpr ShapeDescriptor descriptor = Type::descriptor();
    for (const ShapeField<Type>& field : descriptor.fields) {
      if (field.key) std::visit([&](auto member) { visitor(field.key, field.quantity, shape.*member); }, field.value);
    }
  }
};

inline constexpr double kEndless = std::numeric_limits<double>::infinity();

inline Mat3 diagonal_inertia(double xx, double yy, double zz) { return Vec3(xx, yy, zz).asDiagonal(); }

}  // namespace rigor::inline scene
