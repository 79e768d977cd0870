#include "core/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>

namespace rigor::inline scene {
namespace {

const Vec3* first_of_kind(const Joint& joint, JointVector wanted) {
  const Vec3* found = nullptr;
  for_each_vector(joint.type, [&](const char*, JointVector kind, const Vec3& vector) {
    if (!found && kind == wanted) found = &vector;
  });
  return found;
}

}  // namespace

ContactLaw Scene::contact_law(int a, int b) const {
  for (const ContactPair& pair : contact_pairs) {
    if ((pair.a == a && pair.b == b) || (pair.a == b && pair.b == a)) return pair.law;
  }
  return contact_default;
}

std::string Scene::joint_name(std::size_t index) const {
  const Joint& joint = joints[index];
  if (!joint.name.empty()) return fmt::format("joint '{}'", joint.name);
  return fmt::format("the {} of '{}' and '{}'", joint_type_name(joint), body_name(joint.a), body_name(joint.b));
}

std::string Scene::coupling_name(std::size_t index) const {
  const Coupling& row = couplings[index];
  std::string others;
  for (const JointTerm& term : row.to)
    others += (others.empty() ? "" : " and ") + joint_name(static_cast<std::size_t>(term.joint));
  return fmt::format("the coupling of {} to {}", joint_name(static_cast<std::size_t>(row.joint)), others);
}

bool Coupling::joins(int other) const {
  return joint == other ||
         std::any_of(to.begin(), to.end(), [&](const JointTerm& term) { return term.joint == other; });
}

void renumber_joints(Scene& scene, const std::function<int(int)>& number) {
  const auto renumber = [&](int& joint, std::vector<JointTerm>& terms) {
    joint = number(joint);
    for (JointTerm& term : terms) term.joint = number(term.joint);
  };
  for (Motor& motor : scene.motors) renumber(motor.joint, motor.plus);
  for (Coupling& coupling : scene.couplings) renumber(coupling.joint, coupling.to);
}

BodyPose Scene::pose(int body) const {
  return body == kWorld ? BodyPose{} : BodyPose{bodies[body].position, bodies[body].orientation};
}

double Scene::extension_at_start(const Spring& spring) const {
  const BodyPose a = pose(spring.a), b = pose(spring.b);
  return (b.position + b.orientation * spring.point_b - a.position - a.orientation * spring.point_a).stableNorm() -
         spring.rest_length;
}

std::string joint_type_name(const Joint& joint) { return joint_types()[joint.type.index()].word; }

bool is_axis_of_compound(const Joint& joint) { return std::holds_alternative<CompoundAxis>(joint.type); }

bool turns(const Joint& joint) {
  if (const auto* axis = std::get_if<CompoundAxis>(&joint.type)) return axis->own().turns;
  return joint_types()[joint.type.index()].coordinate == FreeCoordinate::angle;
}

const Vec3* anchor_of(const Joint& joint) {
  if (const auto* axis = std::get_if<CompoundAxis>(&joint.type))
    return axis->own().turns ? &axis->own().anchor : nullptr;
  return first_of_kind(joint, JointVector::point);
}

const Vec3* axis_of(const Joint& joint) { return first_of_kind(joint, JointVector::direction); }

const Vec3* free_axis(const Joint& joint) {
  if (const auto* axis = std::get_if<CompoundAxis>(&joint.type)) return &axis->own().axis;
  return joint_types()[joint.type.index()].coordinate == FreeCoordinate::none ? nullptr : axis_of(joint);
}

}  // namespace rigor::inline scene
