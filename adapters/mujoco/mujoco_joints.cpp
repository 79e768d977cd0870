// The elements of MJCF that stand for joints, loops and couplings.
#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "adapters/mujoco/mujoco_mjcf.h"

namespace rigor::inline adapters {

std::vector<MjcfJoint> mjcf_joints(const Scene& scene, int index, int hanging_body) {
  const Joint& joint = scene.joints[index];
  using Elements = std::vector<MjcfJoint>;
  const bool is_b = joint.b == hanging_body;
  return std::visit(
      ForJoints{[](const BallJoint& type) -> Elements {
                  return {{"ball", type.anchor, {}}};
                },
                [](const CompoundAxis&) -> Elements { return {}; },
                [&](const CompoundJoint& type) {
                  Elements rows;
                  for (std::size_t i = 0; i < type.axes.size(); ++i) {
                    const SeriesAxis& axis = type.axes[i];
                    rows.push_back({axis.turns ? "hinge" : "slide",
                                    axis.turns ? std::optional(axis.anchor) : std::nullopt, axis.axis,
                                    index + 1 + static_cast<int>(i)});
                  }
                  if (!is_b) std::reverse(rows.begin(), rows.end());
                  return rows;
                },
                [](const CylindricalJoint& type) -> Elements {
                  return {{"slide", {}, type.axis}, {"hinge", type.anchor, type.axis}};
                },
                [](const DistanceJoint&) -> Elements { return {}; }, [](const FixedJoint&) -> Elements { return {}; },
                [&](const HingeJoint& type) -> Elements {
                  return {{"hinge", type.anchor, type.axis, index}};
                },
                [](const PlanarJoint& type) -> Elements {
                  const PlaneDirections plane(type.normal);
                  return {{"slide", {}, plane.first}, {"slide", {}, plane.second}, {"hinge", type.anchor, type.normal}};
                },
                [](const ScrewJoint& type) -> Elements {
                  return {{"slide", {}, type.axis}, {"hinge", type.anchor, type.axis}};
                },
                [&](const SliderJoint& type) -> Elements {
                  return {{"slide", {}, type.axis, index}};
                },
                [&](const UniversalJoint& type) -> Elements {
                  return {{"hinge", type.anchor, is_b ? type.axis : type.axis2},
                          {"hinge", type.anchor, is_b ? type.axis2 : type.axis}};
                }},
      joint.type);
}

int body_on(const Scene& scene, const SpanningTree& tree, int joint) {
  const auto* axis = std::get_if<CompoundAxis>(&scene.joints[joint].type);
  const int whole = axis ? joint - 1 - static_cast<int>(axis->index) : joint;
  for (const int body : {scene.joints[joint].a, scene.joints[joint].b})
    if (body != kWorld && !scene.bodies[body].fixed && tree.links[body].joint == whole) return body;
  return kWorld;
}

bool closes_loop(const Scene& scene, const SpanningTree& tree, int joint) {
  return body_on(scene, tree, joint) == kWorld;
}

std::vector<MjcfCoupling> mjcf_couplings(const Scene& scene, const SpanningTree& tree, const MjcfElementName& name_of,
                                         const std::function<double(int joint)>& sign_of) {
  constexpr std::size_t kOnly = 3;
  std::vector<MjcfCoupling> rows;
  for (int k = 0; k < static_cast<int>(scene.joints.size()); ++k) {
    const auto* screw = std::get_if<ScrewJoint>(&scene.joints[k].type);
    if (!screw || closes_loop(scene, tree, k)) continue;
    rows.push_back({name_of(k, 0), {{name_of(k, 1), screw->pitch / (2 * std::numbers::pi)}}, 0});
  }
  for (const Coupling& coupling : scene.couplings) {
    if (is_of_a_loop(scene, tree, coupling)) continue;
    const double sign = sign_of(coupling.joint);
    MjcfCoupling& row = rows.emplace_back(MjcfCoupling{name_of(coupling.joint, kOnly), {}, sign * coupling.offset});
    for (const JointTerm& term : coupling.to)
      row.others.push_back({name_of(term.joint, kOnly), sign * sign_of(term.joint) * term.ratio});
  }
  return rows;
}

bool is_of_a_loop(const Scene& scene, const SpanningTree& tree, const Coupling& coupling) {
  const auto closes = [&](const JointTerm& term) { return closes_loop(scene, tree, term.joint); };
  return closes_loop(scene, tree, coupling.joint) || std::any_of(coupling.to.begin(), coupling.to.end(), closes);
}

std::string MjcfCoupling::tendon(std::size_t number) const {
  if (others.size() == 1) return "";
  std::string joints = fmt::format(R"(<joint joint="{}" coef="1"/>)", first);
  for (const auto& [element, ratio] : others)
    joints += fmt::format(R"(<joint joint="{}" coef="{}"/>)", element, -ratio);
  return fmt::format("<fixed name=\"coupling{}\">{}</fixed>\n", number, joints);
}

std::string MjcfCoupling::equality(std::size_t number) const {
  if (others.size() > 1)
    return fmt::format("<tendon tendon1=\"coupling{}\" polycoef=\"{} 0 0 0 0\"/>\n", number, constant);
  return fmt::format("<joint joint1=\"{}\" joint2=\"{}\" polycoef=\"{} {} 0 0 0\"/>\n", first, others.front().element,
                     constant, others.front().ratio);
}

MjcfLoop mjcf_loop(const Joint& joint) {
  using Equality = MjcfLoop::Equality;
  const auto none = [](const auto&) -> MjcfLoop { return {Equality::none}; };
  return std::visit(
      ForJoints{
          [](const BallJoint& type) -> MjcfLoop {
            return {Equality::connect, {type.anchor}};
          },
          [&](const CompoundAxis& type) { return none(type); }, [&](const CompoundJoint& type) { return none(type); },
          [&](const CylindricalJoint& type) { return none(type); },
          [](const DistanceJoint&) -> MjcfLoop { return {Equality::tendon}; },
          [](const FixedJoint&) -> MjcfLoop { return {Equality::weld}; },
          [](const HingeJoint& type) -> MjcfLoop {
            return {Equality::connect, {type.anchor, type.anchor + type.axis}};
          },
          [&](const PlanarJoint& type) { return none(type); }, [&](const ScrewJoint& type) { return none(type); },
          [&](const SliderJoint& type) { return none(type); }, [&](const UniversalJoint& type) { return none(type); }},
      joint.type);
}

double mjcf_frictionloss(const Scene& scene, int joint) {
  double most = 0;
  for (const Motor& motor : scene.motors) {
    if (motor.joint == joint && motor.is_friction) most += motor.most;
  }
  return most;
}

}  // namespace rigor::inline adapters
