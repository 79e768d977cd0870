// The descriptor of a joint type: its word in case files, its vectors, and the relative motions that it locks. Each
// type has one file in this folder, and one row in joint_types.h. Readers, writers, checks and truths work from the
// descriptor. An engine needs one function for each type that it supports.
#pragma once

#include <array>
#include <optional>

#include "core/base/math.h"

namespace rigor::inline scene {

// The motions of b relative to a, as bits of a mask. The z axis of the joint's frame is the joint's axis; its origin is
// the anchor, or b's centre of mass where there is no anchor.
struct Lock {
  static constexpr unsigned shift_x = 1, shift_y = 2, shift_z = 4, turn_x = 8, turn_y = 16, turn_z = 32;
  static constexpr unsigned across = shift_x | shift_y, shifts = across | shift_z;
  static constexpr unsigned tilt = turn_x | turn_y, turns = tilt | turn_z;
};

// In which frame a joint's vector is given: W at t = 0, or the frame of one of its bodies.
enum class JointVector { point, direction, point_of_a, point_of_b };  // m; unit; m; m

// The coordinate on which a spring, a damper, limits and motors act: an angle [rad] or a displacement [m] along the
// axis.
enum class FreeCoordinate { none, angle, displacement };

template <typename Type>
struct JointField {
  const char* key = nullptr;  // of case files and of JSON
  JointVector kind = JointVector::point;
  Vec3 Type::*value = nullptr;
};

template <typename Type>
struct JointNumber {
  const char* key = nullptr;  // of case files and of JSON
  double Type::*value = nullptr;
};

template <typename Type>
struct JointDescriptor {
  const char* word;                             // of case files, JSON and features ("joint:hinge")
  const char* meaning;                          // one line of documentation
  std::array<JointField<Type>, 3> fields = {};  // the unused ones have no key
  std::optional<unsigned> locks = {};           // a mask of Lock; empty where no mask describes the constraint
  FreeCoordinate coordinate = FreeCoordinate::none;
  JointNumber<Type> number = {};  // without a key if the type has none
  bool has_own_vectors = false;   // Type::visit_vectors(joint, visitor) visits vectors that are no fields

  template <typename Joint, typename Visitor>
  static void visit(Joint& joint, const Visitor& visitor) {
    constexpr JointDescriptor descriptor = Type::descriptor();
    if constexpr (descriptor.has_own_vectors) Type::visit_vectors(joint, visitor);
    for (const JointField<Type>& field : descriptor.fields)
      if (field.key) visitor(field.key, field.kind, joint.*field.value);
  }
};

}  // namespace rigor::inline scene
