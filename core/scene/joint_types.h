// The table of joint types, in alphabetical order, and what its readers need of any row.
#pragma once

#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/scene/joints/ball_joint.h"
#include "core/scene/joints/cylindrical_joint.h"
#include "core/scene/joints/distance_joint.h"
#include "core/scene/joints/fixed_joint.h"
#include "core/scene/joints/hinge_joint.h"
#include "core/scene/joints/slider_joint.h"
#include "core/scene/joints/universal_joint.h"

namespace rigor {

using JointType =
    std::variant<BallJoint, CylindricalJoint, DistanceJoint, FixedJoint, HingeJoint, SliderJoint, UniversalJoint>;

// A row of the table as plain data.
struct JointTypeInfo {
  std::string word, meaning;
  std::vector<std::string> keys;  // of its vectors
  FreeCoordinate coordinate;
  JointType prototype;  // its vectors are zero
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

// One lambda for each joint type, for std::visit.
template <typename... Cases>
struct ForJoints : Cases... {
  using Cases::operator()...;
};
template <typename... Cases>
ForJoints(Cases...) -> ForJoints<Cases...>;

}  // namespace rigor
