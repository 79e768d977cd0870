// The vocabulary of features: what a scene may need, and what an engine may declare. Plug-ins, JSON and messages use
// the words of feature_words(). To add a feature, add an enumerator here and its word in feature.cpp. Features of joint
// types and of pairs of shapes follow from the tables of joints and shapes.
#pragma once

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <variant>
#include <vector>

#include "core/scene/scene.h"

namespace rigor::inline scene {

enum class Feature : int {
  armature,        // inertia of a rotor on a joint's axis
  contact_filter,  // pairs of bodies that never touch
  coupling,        // two joints' coordinates in a fixed ratio
  coupling_of_several_joints,
  fixed_body,        // a fixed body that is no plane
  friction_coulomb,  // a finite coefficient above zero
  friction_infinite,
  friction_none,
  hunt_crossley,  // a soft contact with a dissipation
  joint_damper,
  joint_friction,  // Coulomb friction of a hinge or slider
  joint_limit,
  joint_limit_beyond_half_turn,    // a limit of an angle beyond -pi or pi
  joint_limit_of_compound_slider,  // a limit on a slider of a compound joint, in a scene with contacts
  joint_limit_that_bounces,        // a limit with a restitution
  joint_loop,                      // joints that close a loop, through bodies or through the world
  joint_spring,
  joints_with_contacts,
  joints_with_dampers,
  motor_effort,
  motor_servo,
  motor_servo_of_several_joints,
  motor_speed,
  motor_table,       // an effort that changes in time
  placed_shapes,     // shapes with poses, several of them for one body
  quadratic_spring,  // a spring, also of a joint, whose stiffness grows with its extension
  restitution,
  rolling_friction,
  soft_contact,             // a contact with a stiffness
  speed_motor_with_limits,  // a joint with limits and a motor that keeps a speed
  spring,
  static_friction,  // more friction of points that do not slide
  timed_force,
  torsional_friction,
  two_speeds_at_once,  // a joint with two motors that keep speeds at the same time
  wrench,              // of a plug-in: it applies the forces and torques that Rigor computes
  // One value for each joint type starts here, then one for each pair of shapes. Call joint_feature() and
  // contact_feature() to get them.
  first_joint,
  first_contact = first_joint + static_cast<int>(std::variant_size_v<JointType>),
};

using Features = std::set<Feature>;

struct FeatureWord {
  Feature feature;
  std::string word;  // "spring", "joint:hinge", "contact:box-plane" (the two shapes in alphabetical order)
};
// Every feature once. Pairs that stand still, such as two planes, are missing.
const std::vector<FeatureWord>& feature_words();
const std::string& word_of(Feature feature);
std::optional<Feature> feature_of(std::string_view word);

// The index of a type among the alternatives of a variant.
template <typename Type, typename... Types>
constexpr int index_among(const std::variant<Types...>*) {
  constexpr bool is_same[] = {std::is_same_v<Type, Types>...};
  return static_cast<int>(std::find(std::begin(is_same), std::end(is_same), true) - std::begin(is_same));
}

// The value of each pair of alternatives of Shape, in either order.
constexpr Feature contact_feature(int shape_a, int shape_b) {
  const auto [first, second] = std::minmax(shape_a, shape_b);
  return static_cast<Feature>(static_cast<int>(Feature::first_contact) + second * (second + 1) / 2 + first);
}
inline Feature contact_feature(const Shape& a, const Shape& b) {
  return contact_feature(static_cast<int>(a.index()), static_cast<int>(b.index()));
}
template <typename A, typename B>
constexpr Feature contact_feature() {
  constexpr const Shape* shapes = nullptr;
  return contact_feature(index_among<A>(shapes), index_among<B>(shapes));
}
inline bool is_contact(Feature feature) { return feature >= Feature::first_contact; }

inline Feature joint_feature(const JointType& type) {
  return static_cast<Feature>(static_cast<int>(Feature::first_joint) + static_cast<int>(type.index()));
}
template <typename Type>
constexpr Feature joint_feature() {
  return static_cast<Feature>(static_cast<int>(Feature::first_joint) +
                              index_among<Type>(static_cast<const JointType*>(nullptr)));
}
inline bool is_joint(Feature feature) { return feature >= Feature::first_joint && feature < Feature::first_contact; }

// Whether two shapes, by their index in Shape, can meet: one of them may move.
template <typename... Types>
constexpr bool can_meet(int a, int b, const std::variant<Types...>*) {
  constexpr bool stand[] = {kStandsStill<Types>...};
  return !(stand[a] && stand[b]);
}
constexpr bool can_meet(int a, int b) { return can_meet(a, b, static_cast<const Shape*>(nullptr)); }

// Every pair of these shapes, and of all shapes, that can meet.
template <typename... Types>
Features contacts_among() {
  Features contacts;
  constexpr const Shape* shapes = nullptr;
  constexpr int places[] = {index_among<Types>(shapes)...};
  for (const int a : places) {
    for (const int b : places)
      if (can_meet(a, b)) contacts.insert(contact_feature(a, b));
  }
  return contacts;
}
// The pairs of one shape with each of these.
template <typename On, typename... Types>
Features contacts_on() {
  return {contact_feature<On, Types>()...};
}
Features contacts_of_all_shapes();
Features joints_of_all_types();
template <typename... Types>
Features joints_of_types() {
  return {joint_feature<Types>()...};
}

// `a` and `b` together.
Features joined(Features a, const Features& b);

}  // namespace rigor::inline scene
