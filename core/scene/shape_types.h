// The table of shapes, in alphabetical order, and what its readers need of any row.
#pragma once

#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/scene/body_pose.h"
#include "core/scene/shapes/box.h"
#include "core/scene/shapes/capsule.h"
#include "core/scene/shapes/compound.h"
#include "core/scene/shapes/convex.h"
#include "core/scene/shapes/cylinder.h"
#include "core/scene/shapes/ellipsoid.h"
#include "core/scene/shapes/heightfield.h"
#include "core/scene/shapes/mesh.h"
#include "core/scene/shapes/plane.h"
#include "core/scene/shapes/sphere.h"

namespace rigor::inline scene {

using Shape = std::variant<Box, Capsule, Compound, Convex, Cylinder, Ellipsoid, Heightfield, Mesh, Plane, Sphere>;

// Shapes of bodies that are fixed and have no other shape.
template <typename Type>
inline constexpr bool kStandsStill = std::is_same_v<Type, Plane> || std::is_base_of_v<SurfaceShape, Type>;

struct PlacedShape {
  Shape shape;
  BodyPose pose;  // in B
};

// A row of the table as plain data.
struct ShapeInfo {
  std::string word, meaning;
  std::vector<std::string> keys;  // of its fields
  bool stands_still;              // planes and surfaces: their bodies are fixed, and have no other shape
  bool is_solid;                  // neither that nor a compound
  Shape prototype;                // its fields have no meaning
};
const std::vector<ShapeInfo>& shape_types();

// "box", "capsule", …: the word that case files use.
std::string shape_name(const Shape& shape);

// Calls visitor(key, quantity, value) for each field of a shape; the value is a double or a Vec3.
template <typename Visitor>
void for_each_field(Shape& shape, const Visitor& visitor) {
  std::visit([&](auto& it) { ShapeDescriptor<std::decay_t<decltype(it)>>::visit(it, visitor); }, shape);
}
template <typename Visitor>
void for_each_field(const Shape& shape, const Visitor& visitor) {
  std::visit([&](const auto& it) { ShapeDescriptor<std::decay_t<decltype(it)>>::visit(it, visitor); }, shape);
}

bool stands_still(const Shape& shape);
const SurfaceShape* surface_in(const Shape& shape);  // null for another shape

// Calls visitor(shape, pose in B) for the shape, or for each part of a compound.
template <typename Visitor>
void for_each_part(const Shape& shape, const Visitor& visitor) {
  if (const auto* compound = std::get_if<Compound>(&shape)) {
    for (const PlacedShape& part : compound->parts) visitor(part.shape, part.pose);
  } else {
    visitor(shape, BodyPose());
  }
}

// One lambda for each shape, for std::visit.
template <typename... Cases>
struct ForShapes : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
ForShapes(Cases...) -> ForShapes<Cases...>;

// m³; m, the centre of mass in B; kg m², about that centre, of a body of even density. A plane has none of these.
double volume_of(const Shape& shape);
Vec3 centre_of(const Shape& shape);
Mat3 inertia_of(const Shape& shape, double mass);

double bounding_radius(const Shape& shape);  // m, about the body's origin
double inradius(const Shape& shape);         // m: a motion by less cannot pass through the shape
Vec3 support(const Shape& shape, const Vec3& n);
TriangleMesh drawn_mesh(const Shape& shape);

// The shape with all its lengths multiplied by `factor` > 0.
Shape scaled_shape(const Shape& shape, double factor);

// b, given in a's frame, in the frame that a is given in.
BodyPose operator*(const BodyPose& a, const BodyPose& b);
BodyPose inverse(const BodyPose& pose);

}  // namespace rigor::inline scene
