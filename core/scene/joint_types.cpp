#include "core/scene/joint_types.h"

#include <utility>

namespace rigor::inline scene {
namespace {

template <typename Type>
JointTypeInfo row_of_type() {
  constexpr JointDescriptor<Type> descriptor = Type::descriptor();
  std::vector<std::string> keys;
  Type prototype;
  JointDescriptor<Type>::visit(prototype, [&](const char* key, JointVector, Vec3& vector) {
    keys.push_back(key);
    vector.setZero();
  });
  if (descriptor.number.key) keys.push_back(descriptor.number.key);
  return {descriptor.word,       descriptor.meaning, std::move(keys),
          descriptor.coordinate, prototype,          !std::is_same_v<Type, CompoundAxis>};
}

template <typename... Types>
std::vector<JointTypeInfo> rows_of(const std::variant<Types...>*) {
  return {row_of_type<Types>()...};
}

}  // namespace

const std::vector<JointTypeInfo>& joint_types() {
  static const std::vector<JointTypeInfo> rows = rows_of(static_cast<const JointType*>(nullptr));
  return rows;
}

}  // namespace rigor::inline scene
