// The table of joint types, in alphabetical order, and what its readers need of any row.
#pragma once

#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/scene/joints/ball_joint.h"
#include "core/scene/joints/compound_joint.h"
#include "core/scene/joints/cylindrical_joint.h"
#include "core/scene/joints/distance_joint.h"
#include "core/scene/joints/fixed_joint.h"
#include "core/scene/joints/hinge_joint.h"
#include "core/scene/joints/planar_joint.h"
#include "core/scene/joints/screw_joint.h"
#include "core/scene/joints/slider_joint.h"
#include "core/scene/joints/universal_joint.h"

namespace rigor::inline scene {

using JointType = std::variant<BallJoint, CompoundAxis, CompoundJoint, CylindricalJoint, DistanceJoint, FixedJoint,
                               HingeJoint, PlanarJoint, ScrewJoint, SliderJoint, UniversalJoint>;

// A row of the table as plain data.
struct JointTypeInfo {
  std::string word, meaning;
  std::vector<std::string> keys;  // of its vectors and its number
  FreeCoordinate coordinate;
  JointType prototype;   // its vectors are zero
  bool is_whole = true;  // false for a part of another type, which has no word in case files
};
const std::vector<JointTypeInfo>& joint_types();

// Calls visitor(key, kind, vector) for each vector of a joint.
template <typename Visitor>
void for_each_vector(JointType& type, const Visitor& visitor) {
  std::visit([&](auto& joint) { JointDescriptor<std::decay_t<decltype(joint)>>::visit(joint, visitor); }, type);
}
template <typename Visitor>
void for_each_vector(const JointType& type, const Visitor& visitor) {
  std::visit([&](const auto& joint) { JointDescriptor<std::decay_t<decltype(joint)>>::visit(joint, visitor); }, type);
}

// Calls visitor(key, number) for the number of a joint that has one.
template <typename Joint, typename Visitor>
void for_each_number(Joint&& type, const Visitor& visitor) {
  std::visit(
      [&](auto& joint) {
        constexpr auto number = std::decay_t<decltype(joint)>::descriptor().number;
        if constexpr (number.key != nullptr) visitor(number.key, joint.*number.value);
      },
      type);
}

// One lambda for each joint type, for std::visit.
template <typename... Cases>
struct ForJoints : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
ForJoints(Cases...) -> ForJoints<Cases...>;

// Cases of ForJoints for the types that an engine lacks. Features keep these away from it; the result is empty.
template <typename Result, typename Type>
struct LackingJoint {
  Result operator()(const Type&) const { return Result(); }
};
template <typename Result, typename... Types>
struct LackingJoints : LackingJoint<Result, Types>... {
  using LackingJoint<Result, Types>::operator()...;
};

}  // namespace rigor::inline scene
