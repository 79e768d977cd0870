// MuJoCo's conventions and ours: a joint's anchor and axis are in its body's frame. A scene's joint counts from where
// it is at t = 0, MuJoCo's from qpos0. Quaternions are (w, x, y, z).
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "adapters/mjcf/mjcf_import.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor::inline adapters {
namespace {

using namespace mjcf;

double larger_of(double a, double b) { return std::max(a, b); }

void read_medium(MjcfImport& import) {
  const CompiledMjcf& m = import.m;
  LeftOut& left_out = import.model.left_out;
  const std::string& path = import.source.path;
  import.model.gravity = import.vector("opt_gravity", 0);
  const auto lose_if = [&](bool is_there, const std::string& what, const std::string& why) {
    if (is_there) left_out.add(path, what, lost(why));
  };
  lose_if(m.at("opt_density", 0) != 0 || m.at("opt_viscosity", 0) != 0, "a fluid", "no scene has a medium");
  lose_if(m.at("nflex", 0) > 0, "flexible bodies", "a scene's bodies are rigid");
  lose_if(m.at("nplugin", 0) > 0, "plugins", "are programs of MuJoCo, and none runs");
  lose_if(m.at("npair", 0) > 0, "contact pairs", "have surfaces of their own; those of their geoms are taken");
  lose_if(m.off.contains("filterparent"), "contacts with parents", "links of a joint never touch in the import");
  if (m.at("nsensor", 0) > 0) left_out.add(path, "sensors", no_motion("only measure"));
  if (m.at("nskin", 0) > 0) left_out.add(path, "skins", no_motion("are only drawn"));
  left_out.add(path, "softness",
               assumed("contacts, limits and equalities are soft in MuJoCo's solver, and hard in a scene"));
  for (const std::string& warning : m.warnings)
    left_out.add(path, "a warning", assumed(fmt::format("{}: {}", m.parser, warning)));
}

void read_body(MjcfImport& import, int body) {
  const std::string name = import.m.name_of("body", static_cast<std::size_t>(body));
  Link link{name.empty() ? fmt::format("body{}", body) : name, import.at("body", body), {}};
  link.pose = {import.vector("xpos", body), import.turn("xquat", body)};
  link.angular_velocity = import.vector("velocity", 2 * body), link.velocity = import.vector("velocity", 2 * body + 1);
  link.touches_own_model = true;
  link.is_static = import.whole("body_mocapid", body) >= 0 && import.m.has("body_mocapid");
  link.lifted = import.value("body_gravcomp", body);
  if (link.is_static)
    import.model.left_out.add(link.where, "a mocap body", no_motion("stays where it is until a program moves it"));
  if (const double mass = import.value("body_mass", body); mass > 0) {
    const BodyPose inertial{import.vector("body_ipos", body), import.turn("body_iquat", body)};
    link.inertial.push_back({mass, link.pose * inertial, Mat3(import.vector("body_inertia", body).asDiagonal())});
  }
  import.model.links.push_back(std::move(link));
}

// A free joint or a ball has no axis to act on.
void lose_what_acts_without_axis(MjcfImport& import, int joint, int coordinates) {
  const char* kWhy = "acts on a joint without an axis, which a scene's does not";
  const int dof = import.whole("jnt_dofadr", joint);
  for (const char* name : {"armature", "damping", "frictionloss"}) {
    bool acts = false;
    for (int k = 0; k < coordinates; ++k) acts = acts || import.value(fmt::format("dof_{}", name), dof + k) != 0;
    if (acts) import.lose("joint", joint, name, kWhy);
  }
  if (import.value("jnt_stiffness", joint) != 0) import.lose("joint", joint, "stiffness", kWhy);
  if (import.whole("jnt_limited", joint)) import.lose("joint", joint, "range of a ball", kWhy);
}

void lose_powers(MjcfImport& import, int joint) {
  const int dof = import.whole("jnt_dofadr", joint);
  for (int k = 0; k < 2; ++k) {
    if (import.value("jnt_stiffnesspoly", 2 * joint + k) != 0 || import.value("dof_dampingpoly", 2 * dof + k) != 0)
      return import.lose("joint", joint, "a spring or damper of higher powers", "a scene's are linear");
  }
}

// A hinge or a slider with all that acts on its coordinate.
LinkJoint axis_joint(MjcfImport& import, int joint) {
  // The body's own frame would not do: of joints in series, the later ones have turned it.
  const Vec3 anchor = import.vector("xanchor", joint), axis = import.vector("xaxis", joint).normalized();
  LinkJoint row;
  row.where = import.at("joint", joint);
  row.joint.name = import.m.name_of("joint", static_cast<std::size_t>(joint));
  if (import.whole("jnt_type", joint) == kHinge) row.joint.type = HingeJoint{anchor, axis};
  if (import.whole("jnt_type", joint) == kSlide) row.joint.type = SliderJoint{axis};
  const int q = import.whole("jnt_qposadr", joint), dof = import.whole("jnt_dofadr", joint);
  const double start = import.start_of(joint);
  row.joint.stiffness = import.value("jnt_stiffness", joint), row.joint.damping = import.value("dof_damping", dof);
  row.joint.rest = row.joint.stiffness > 0 ? import.value("qpos_spring", q) - start : 0;
  row.friction = import.value("dof_frictionloss", dof);
  row.armature = import.value("dof_armature", dof);
  if (import.whole("jnt_limited", joint))
    row.joint.lower = import.value("jnt_range", 2 * joint) - start,
    row.joint.upper = import.value("jnt_range", 2 * joint + 1) - start;
  if (row.joint.stiffness > 0 && import.may_turn_round(joint))
    import.lose("joint", joint, "a spring beyond half a turn", "a scene's spring does not count whole turns");
  lose_powers(import, joint);
  return row;
}

// Several joints of a body stand in series, with links without mass between them.
void add_series(MjcfImport& import, int body, int parent, int first, int count) {
  for (int k = 0; k < count; ++k) {
    LinkJoint row = axis_joint(import, first + k);
    row.joint.a = k == 0 ? parent : static_cast<int>(import.model.links.size()) - 1;
    row.joint.b = MjcfImport::link_of(body);
    if (k + 1 < count) {
      Link between{fmt::format("{}/{}", import.model.links[MjcfImport::link_of(body)].name, k + 1), row.where, {}};
      between.pose = import.pose_of(body), between.touches_own_model = true;
      import.model.links.push_back(std::move(between));
      row.joint.b = static_cast<int>(import.model.links.size()) - 1;
    }
    import.row_of_joint[first + k] = static_cast<int>(import.model.joints.size());
    import.model.joints.push_back(std::move(row));
  }
}

void read_joints(MjcfImport& import, int body) {
  const int count = import.whole("body_jntnum", body), first = import.whole("body_jntadr", body);
  // MuJoCo lets a body touch a parent that is part of the world, and no other parent.
  const int above = import.whole("body_parentid", body);
  const int parent = import.whole("body_weldid", above) == 0 ? kWorld : MjcfImport::link_of(above);
  const auto type = [&](int joint) { return import.whole("jnt_type", joint); };
  LinkJoint row;
  row.joint.a = parent, row.joint.b = MjcfImport::link_of(body);
  if (count == 0) {
    if (import.model.links[row.joint.b].is_static) return;
    row.where = import.at("body", body), row.joint.type = FixedJoint{};
    import.model.joints.push_back(std::move(row));
    return;
  }
  if (count == 1 && type(first) == kFree) return lose_what_acts_without_axis(import, first, 6);
  bool all_have_axes = true;
  for (int k = first; k < first + count; ++k) all_have_axes = all_have_axes && type(k) >= kSlide;
  if (all_have_axes) return add_series(import, body, parent, first, count);
  for (int k = first; k < first + count; ++k) {
    if (type(k) == kBall) lose_what_acts_without_axis(import, k, 3);
  }
  if (count > 1)
    return import.lose("body", body, "a ball in series with other joints",
                       "no joint of a scene equals them: it is free");
  row.where = import.at("joint", first), row.joint.name = import.m.name_of("joint", static_cast<std::size_t>(first));
  row.joint.type = BallJoint{import.vector("xanchor", first)};
  import.model.joints.push_back(std::move(row));
}

void check_keyframe(const MjcfSource& source, const CompiledMjcf& m) {
  std::vector<std::string> names;
  const auto keys = m.names.find("keyframe");
  for (std::size_t k = 0; keys != m.names.end() && k < keys->second.size(); ++k)
    names.push_back(keys->second[k].empty() ? std::to_string(k) : keys->second[k]);
  if (source.keyframe.empty()) return;
  if (std::find(names.begin(), names.end(), source.keyframe) == names.end())
    throw InputError(fmt::format("{}:1: has no keyframe '{}'{}; it has: {}", source.path, source.keyframe,
                                 did_you_mean(source.keyframe, names), names.empty() ? "none" : listed(names)));
}

// Motors and couplings name their joints.
void name_joints(LinkModel& model) {
  for (std::size_t k = 0; k < model.joints.size(); ++k) {
    if (model.joints[k].joint.name.empty() && free_axis(model.joints[k].joint))
      model.joints[k].joint.name = fmt::format("joint {}", k);
  }
}

}  // namespace

bool MjcfImport::may_turn_round(int joint) const {
  if (whole("jnt_type", joint) != kHinge) return false;
  return !whole("jnt_limited", joint) ||
         value("jnt_range", 2 * joint + 1) - value("jnt_range", 2 * joint) >= 2 * std::numbers::pi;
}

LinkModel links_of_mjcf(const MjcfSource& source, CompiledMjcf compiled) {
  check_keyframe(source, compiled);
  compiled.take_switches();
  MjcfImport import{source, compiled};
  import.model.name = compiled.name_of("model", 0);
  if (import.model.name.empty()) import.model.name = "model";
  import.model.combine = larger_of;
  read_medium(import);
  const int bodies = import.count("body_parentid");
  import.model.has_state = !source.keyframe.empty();
  import.row_of_joint.assign(compiled.size("jnt_type"), -1);
  for (int body = 1; body < bodies; ++body) read_body(import, body);
  for (int body = 1; body < bodies; ++body) read_joints(import, body);
  read_mjcf_geoms(import);
  for (const double signature : compiled.numbers["exclude_signature"]) {
    const auto bodies_of = static_cast<int>(signature);  // the first above 16 bits of the second
    import.model.kept_apart.emplace_back(MjcfImport::link_of(bodies_of >> 16), MjcfImport::link_of(bodies_of & 0xffff));
  }
  read_mjcf_constraints(import);
  read_mjcf_actuators(import);
  name_joints(import.model);
  if (const auto keys = compiled.names.find("keyframe");
      keys != compiled.names.end() && !keys->second.empty() && source.keyframe.empty())
    import.model.left_out.add(source.path, "keyframes",
                              assumed("are other starts; the model's own is taken. --keyframe NAME takes one"));
  return std::move(import.model);
}

}  // namespace rigor::inline adapters
