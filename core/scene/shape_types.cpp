#include "core/scene/shape_types.h"

#include <utility>

namespace rigor::inline scene {
namespace {

template <typename Type>
ShapeInfo row_of_shape() {
  constexpr ShapeDescriptor<Type> descriptor = Type::descriptor();
  std::vector<std::string> keys;
  Type prototype = {};
  ShapeDescriptor<Type>::visit(prototype, [&](const char* key, ShapeQuantity, auto& value) {
    keys.push_back(key);
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, Vec3>)
      value.setZero();
    else
      value = 0;
  });
  const bool is_solid = !kStandsStill<Type> && !std::is_same_v<Type, Compound>;
  return {descriptor.word, descriptor.meaning, std::move(keys), kStandsStill<Type>, is_solid, prototype};
}

template <typename... Types>
std::vector<ShapeInfo> rows_of_shapes(const std::variant<Types...>*) {
  return {row_of_shape<Types>()...};
}

}  // namespace

const std::vector<ShapeInfo>& shape_types() {
  static const std::vector<ShapeInfo> rows = rows_of_shapes(static_cast<const Shape*>(nullptr));
  return rows;
}

std::string shape_name(const Shape& shape) { return shape_types()[shape.index()].word; }

bool stands_still(const Shape& shape) {
  return std::visit([](const auto& it) { return kStandsStill<std::decay_t<decltype(it)>>; }, shape);
}

const SurfaceShape* surface_in(const Shape& shape) {
  return std::visit(
      [](const auto& it) -> const SurfaceShape* {
        if constexpr (std::is_base_of_v<SurfaceShape, std::decay_t<decltype(it)>>)
          return &it;
        else
          return nullptr;
      },
      shape);
}

double volume_of(const Shape& shape) {
  return std::visit([](const auto& it) { return it.volume(); }, shape);
}
Vec3 centre_of(const Shape& shape) {
  return std::visit([](const auto& it) { return it.centre(); }, shape);
}
Mat3 inertia_of(const Shape& shape, double mass) {
  return std::visit([=](const auto& it) { return it.inertia(mass); }, shape);
}
double bounding_radius(const Shape& shape) {
  return std::visit([](const auto& it) { return it.bounding_radius(); }, shape);
}
double inradius(const Shape& shape) {
  return std::visit([](const auto& it) { return it.inradius(); }, shape);
}
Vec3 support(const Shape& shape, const Vec3& n) {
  return std::visit([&](const auto& it) { return it.support(n); }, shape);
}
TriangleMesh drawn_mesh(const Shape& shape) {
  return std::visit([](const auto& it) { return it.drawn(); }, shape);
}

Shape scaled_shape(const Shape& shape, double factor) {
  Shape out = shape;
  for_each_field(out, [&](const char*, ShapeQuantity quantity, auto& value) {
    if (quantity != ShapeQuantity::direction) value *= factor;
  });
  if (auto* convex = std::get_if<Convex>(&out)) convex->hull = scaled_hull(*convex->hull, factor);
  if (auto* mesh = std::get_if<Mesh>(&out)) mesh->surface = scaled_surface(*mesh->surface, factor);
  if (auto* field = std::get_if<Heightfield>(&out)) {
    field->surface = scaled_surface(*field->surface, factor);
    for (double& length : field->size) length *= factor;
    for (std::vector<double>& row : field->heights)
      for (double& height : row) height *= factor;
  }
  if (auto* compound = std::get_if<Compound>(&out)) {
    for (PlacedShape& part : compound->parts)
      part.shape = scaled_shape(part.shape, factor), part.pose.position *= factor;
  }
  return out;
}

BodyPose operator*(const BodyPose& a, const BodyPose& b) {
  return {a.position + a.orientation * b.position, (a.orientation * b.orientation).normalized()};
}

BodyPose inverse(const BodyPose& pose) {
  const Quat back = pose.orientation.conjugate();
  return {-(back * pose.position), back};
}

}  // namespace rigor::inline scene
