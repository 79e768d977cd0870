// MuJoCo's conventions and ours: a joint's anchor and axis are given in its body's frame; a scene's joint counts from
// where it is at t = 0, MuJoCo's from qpos0. Quaternions (w, x, y, z); a capsule by
// its half length along z, a box by half edges, a plane by a frame whose z is the normal.
#include "adapters/mujoco/mujoco_import.h"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/mujoco/mujoco_library.h"
#include "adapters/mujoco/mujoco_start.h"
#include "core/base/error.h"

namespace rigor {
namespace {

constexpr const char* kIsSeen = "changes no motion: is only drawn";
constexpr const char* kOfTwo = "a scene's joint of several axes has no limits, springs or dampers";

double largest(double a, double b) { return std::max(a, b); }

Vec3 vector_at(const mjtNum* numbers, int row) {
  return {numbers[3 * row], numbers[3 * row + 1], numbers[3 * row + 2]};
}
Quat turn_at(const mjtNum* numbers, int row) {
  return Quat(numbers[4 * row], numbers[4 * row + 1], numbers[4 * row + 2], numbers[4 * row + 3]).normalized();
}

class Importer {
 public:
  // `state`: the positions to start from, with the bodies where they are there and their velocities.
  Importer(const std::string& path, const mjModel& compiled, const mjData& state)
      : path_(path), m_(compiled), start_(state) {}

  LinkModel read() {
    model_.name = *m_.names ? m_.names : "model";
    model_.combine = largest;
    read_options();
    for (int body = 1; body < m_.nbody; ++body) read_body(body);
    for (int body = 1; body < m_.nbody; ++body) read_joints(body);
    for (int geom = 0; geom < m_.ngeom; ++geom) read_geom(geom);
    for (int k = 0; k < m_.nexclude; ++k)
      model_.kept_apart.emplace_back((m_.exclude_signature[k] >> 16) - 2, (m_.exclude_signature[k] & 0xffff) - 2);
    for (int k = 0; k < m_.neq; ++k) read_equality(k);
    for (int k = 0; k < m_.ntendon; ++k) read_tendon(k);
    for (int k = 0; k < m_.nu; ++k) read_actuator(k);
    for (LinkJoint& row : model_.joints) {
      if (has_motor(row) && row.joint.name.empty())
        row.joint.name = fmt::format("joint {}", &row - model_.joints.data());
    }
    return std::move(model_);
  }

 private:
  std::string name_of(int type, int id, const std::string& otherwise) const {
    const char* name = mj_id2name(&m_, type, id);
    return name && *name ? name : otherwise;
  }
  std::string at(const char* what, int type, int id) const {
    return fmt::format("{}: {} '{}'", path_, what, name_of(type, id, std::to_string(id)));
  }
  void leave_out(const std::string& where, const std::string& what, const std::string& why) {
    model_.left_out.add(where, what, why);
  }
  void leave_out_if(bool is_there, const std::string& where, const std::string& what, const std::string& why) {
    if (is_there) leave_out(where, what, why);
  }
  bool has_motor(const LinkJoint& row) const {
    const int index = static_cast<int>(&row - model_.joints.data());
    return std::any_of(model_.motors.begin(), model_.motors.end(),
                       [&](const Motor& motor) { return motor.joint == index; });
  }
  static int link_of(int body) { return body - 1; }  // the world's is kWorld

  void read_options() {
    const mjOption& option = m_.opt;
    model_.gravity = vector_at(option.gravity, 0);
    leave_out_if((option.disableflags & ~kSwitchesTaken) != 0, path_, "<flag>", "switches off parts of one engine");
    leave_out_if(option.density != 0 || option.viscosity != 0, path_, "density and viscosity",
                 "belong to a medium, which no scene has");
    leave_out_if(m_.nsensor > 0, path_, fmt::format("{} sensors", m_.nsensor), "changes no motion: they only measure");
    leave_out_if(m_.npair > 0, path_, fmt::format("{} contact pairs", m_.npair),
                 "have their own surfaces; those of their geoms are taken");
    leave_out_if(m_.nskin > 0, path_, fmt::format("{} skins", m_.nskin), kIsSeen);
  }

  void read_body(int body) {
    Link link{name_of(mjOBJ_BODY, body, fmt::format("body{}", body)), at("body", mjOBJ_BODY, body), {}};
    link.pose = {vector_at(start_.xpos, body), turn_at(start_.xquat, body)};
    mjtNum velocity[6];  // angular, then linear, of the body's origin
    mj_objectVelocity(&m_, &start_, mjOBJ_XBODY, body, velocity, 0);
    link.angular_velocity = vector_at(velocity, 0), link.velocity = vector_at(velocity, 1);
    link.touches_own_model = true;
    link.is_static = m_.body_mocapid[body] >= 0;
    leave_out_if(link.is_static, link.where, "its being mocap", "would be moved by a program: it stays where it is");
    if (m_.body_mass[body] > 0) {
      const BodyPose inertial{vector_at(m_.body_ipos, body), turn_at(m_.body_iquat, body)};
      link.inertial.push_back(
          {m_.body_mass[body], link.pose * inertial, vector_at(m_.body_inertia, body).asDiagonal()});
    }
    model_.links.push_back(std::move(link));
  }

  BodyPose pose_of(int body) const { return body == 0 ? BodyPose() : model_.links[link_of(body)].pose; }

  // A body without joints is fixed to its parent. One joint becomes a joint of the scene. Two or three hinges that
  // share an anchor become a universal or a ball joint.
  void read_joints(int body) {
    const int count = m_.body_jntnum[body], first = m_.body_jntadr[body];
    LinkJoint row;
    // MuJoCo lets a body touch a parent that is part of the world, and no other parent.
    const int parent = m_.body_parentid[body];
    row.joint.a = m_.body_weldid[parent] == 0 ? kWorld : link_of(parent), row.joint.b = link_of(body);
    row.where = count > 0 ? at("joint", mjOBJ_JOINT, first) : at("body", mjOBJ_BODY, body);
    if (count == 0 && m_.body_mocapid[body] >= 0) return;
    for (int k = first; k < first + count; ++k) leave_out_losses(k);
    if (count == 0) {
      row.joint.type = FixedJoint{};
    } else if (count == 1) {
      if (m_.jnt_type[first] == mjJNT_FREE) return;
      read_only_joint(first, row);
    } else if (!read_several(first, count, row)) {
      return leave_out(row.where, fmt::format("it and {} more of its body", count - 1),
                       "no joint of a scene equals these together: the body is free");
    }
    if (count > 0) row.joint.name = name_of(mjOBJ_JOINT, first, "");
    row_of_joint_.resize(static_cast<std::size_t>(m_.njnt), -1);
    if (count == 1) row_of_joint_[first] = static_cast<int>(model_.joints.size());
    model_.joints.push_back(std::move(row));
  }

  Vec3 anchor_of(int joint) const {
    const BodyPose body = pose_of(m_.jnt_bodyid[joint]);
    return body.position + body.orientation * vector_at(m_.jnt_pos, joint);
  }
  Vec3 axis_of(int joint) const {
    return (pose_of(m_.jnt_bodyid[joint]).orientation * vector_at(m_.jnt_axis, joint)).normalized();
  }

  // Names effects on a joint's speed that no scene has.
  void leave_out_losses(int joint) {
    const int type = m_.jnt_type[joint], dof = m_.jnt_dofadr[joint];
    const bool has_coordinate = type == mjJNT_HINGE || type == mjJNT_SLIDE;
    const std::string where = at("joint", mjOBJ_JOINT, joint);
    leave_out_if(m_.dof_armature[dof] != 0, where, "armature", "is the inertia of a rotor, which no scene has");
    leave_out_if(m_.dof_frictionloss[dof] != 0, where, "frictionloss",
                 "is dry friction, which no joint of a scene has");
    if (!has_coordinate) leave_out_springs(joint);
  }

  void leave_out_springs(int joint) {
    const std::string where = at("joint", mjOBJ_JOINT, joint);
    leave_out_if(m_.dof_damping[m_.jnt_dofadr[joint]] != 0, where, "damping", kOfTwo);
    leave_out_if(m_.jnt_stiffness[joint] != 0, where, "stiffness", kOfTwo);
    leave_out_if(m_.jnt_limited[joint], where, "range", kOfTwo);
  }

  void read_only_joint(int k, LinkJoint& row) {
    if (m_.jnt_type[k] == mjJNT_BALL) {
      row.joint.type = BallJoint{anchor_of(k)};
      return;
    }
    if (m_.jnt_type[k] == mjJNT_HINGE) row.joint.type = HingeJoint{anchor_of(k), axis_of(k)};
    if (m_.jnt_type[k] == mjJNT_SLIDE) row.joint.type = SliderJoint{axis_of(k)};
    const int q = m_.jnt_qposadr[k];
    row.joint.stiffness = m_.jnt_stiffness[k], row.joint.damping = m_.dof_damping[m_.jnt_dofadr[k]];
    row.joint.rest = m_.qpos_spring[q] - start_.qpos[q];
    if (m_.jnt_limited[k])
      row.joint.lower = m_.jnt_range[2 * k] - start_.qpos[q],
      row.joint.upper = m_.jnt_range[2 * k + 1] - start_.qpos[q];
  }

  bool read_several(int first, int count, LinkJoint& row) {
    for (int k = first; k < first + count; ++k) {
      constexpr double kSame = 1e-12;  // m
      if (m_.jnt_type[k] != mjJNT_HINGE || (anchor_of(k) - anchor_of(first)).norm() > kSame || count > 3) return false;
    }
    const Vec3 axis = axis_of(first), axis2 = axis_of(first + 1);
    constexpr double kRight = 1e-9, kIndependent = 1e-3;
    if (count == 2 && std::abs(axis.dot(axis2)) > kRight) return false;
    if (count == 3 && std::abs(axis.cross(axis2).dot(axis_of(first + 2))) < kIndependent) return false;
    for (int k = first; k < first + count; ++k) leave_out_springs(k);
    if (count == 2) row.joint.type = UniversalJoint{anchor_of(first), axis, axis2};
    if (count == 3) row.joint.type = BallJoint{anchor_of(first)};
    return true;
  }

  void read_geom(int geom) {
    const std::string where = at("geom", mjOBJ_GEOM, geom);
    const unsigned type = static_cast<unsigned>(m_.geom_contype[geom]),
                   affinity = static_cast<unsigned>(m_.geom_conaffinity[geom]);
    if (type == 0 && affinity == 0) return leave_out(where, "its shape", kIsSeen);
    const int body = m_.geom_bodyid[geom];
    const BodyPose pose = pose_of(body) * BodyPose{vector_at(m_.geom_pos, geom), turn_at(m_.geom_quat, geom)};
    const mjtNum* size = m_.geom_size + 3 * geom;
    LinkShape out{Sphere{size[0]}, pose, {0, m_.geom_condim[geom] == 1 ? 0 : m_.geom_friction[3 * geom]}, type,
                  affinity,        where};
    switch (m_.geom_type[geom]) {
      case mjGEOM_SPHERE:
        break;
      case mjGEOM_BOX:
        out.shape = Box{2 * Vec3(size[0], size[1], size[2])};
        break;
      case mjGEOM_CAPSULE:
        out.shape = Capsule{size[0], 2 * size[1]};
        break;
      case mjGEOM_PLANE: {
        const Vec3 normal = (pose.orientation * Vec3::UnitZ()).normalized();
        out.shape = Plane{normal, normal.dot(pose.position)};
        break;
      }
      default:
        return leave_out(where, "its shape",
                         "is a cylinder, an ellipsoid, a mesh or a height field: nothing touches it");
    }
    leave_out_if(m_.geom_priority[geom] != 0, where, "priority",
                 "chooses whose surface counts; the greater friction is taken");
    if (body > 0) {
      model_.links[link_of(body)].shapes.push_back(out);
      return;
    }
    Link link{name_of(mjOBJ_GEOM, geom, fmt::format("geom{}", geom)), where, {}};
    link.shapes.push_back(out), link.is_static = true, link.touches_own_model = true;
    model_.links.push_back(std::move(link));
  }

  void read_equality(int k) {
    const std::string where = at("equality", mjOBJ_EQUALITY, k);
    if (!m_.eq_active[k]) return leave_out(where, "it", "changes no motion: is not active");
    LinkJoint row;
    row.where = where, row.joint.name = name_of(mjOBJ_EQUALITY, k, "");
    row.joint.a = link_of(m_.eq_obj2id[k]), row.joint.b = link_of(m_.eq_obj1id[k]);
    const mjtNum* data = m_.eq_data + mjNEQDATA * k;
    constexpr double kClosed = 1e-6;  // digits of a file that a person wrote
    if (const double gap = opening_of(m_, start_, k); gap > kClosed)
      throw InputError(
          fmt::format("{}: is open by {:.3g} (m or rad) where the model starts, and a scene's joints hold "
                      "what they find; allowed: a start, as a keyframe, at which it is closed",
                      where, gap));
    if (m_.eq_type[k] == mjEQ_CONNECT) {
      row.joint.type = BallJoint{(pose_of(m_.eq_obj1id[k]) * BodyPose{Vec3(data[0], data[1], data[2])}).position};
    } else if (m_.eq_type[k] == mjEQ_WELD) {
      row.joint.type = FixedJoint{};
    } else if (m_.eq_type[k] == mjEQ_TENDON && m_.eq_obj2id[k] < 0 && is_straight(m_.eq_obj1id[k])) {
      const Ends ends = ends_of(m_.eq_obj1id[k]);
      row.joint.a = ends.a, row.joint.b = ends.b, row.joint.type = DistanceJoint{ends.point_a, ends.point_b};
    } else {
      return leave_out(where, "it", "couples joints or tendons, which no scene does");
    }
    leave_out(where, "its softness", "belongs to one engine: a scene's joints are hard");
    model_.joints.push_back(std::move(row));
  }

  struct Ends {
    int a, b;
    Vec3 point_a, point_b;  // in the links' frames
  };
  // Between two sites and round nothing.
  bool is_straight(int tendon) const {
    const int* type = m_.wrap_type + m_.tendon_adr[tendon];
    return m_.tendon_num[tendon] == 2 && type[0] == mjWRAP_SITE && type[1] == mjWRAP_SITE;
  }
  Ends ends_of(int tendon) const {
    const int* sites = m_.wrap_objid + m_.tendon_adr[tendon];
    return {link_of(m_.site_bodyid[sites[0]]), link_of(m_.site_bodyid[sites[1]]), vector_at(m_.site_pos, sites[0]),
            vector_at(m_.site_pos, sites[1])};
  }

  void read_tendon(int k) {
    const std::string where = at("tendon", mjOBJ_TENDON, k);
    leave_out_if(m_.tendon_frictionloss[k] != 0, where, "frictionloss",
                 "is dry friction, which no spring of a scene has");
    leave_out_if(m_.tendon_limited[k], where, "range", "bounds a length, which no scene does");
    if (m_.tendon_stiffness[k] == 0 && m_.tendon_damping[k] == 0) return;
    if (!is_straight(k))
      return leave_out(where, "its spring and damper", "a scene's springs are straight, from one point to another");
    const Ends ends = ends_of(k);
    model_.springs.push_back({ends.a, ends.b, ends.point_a, ends.point_b, m_.tendon_stiffness[k], m_.tendon_damping[k],
                              m_.tendon_lengthspring[k]});
  }

  // The control that the drive has at the start. Nothing changes it later.
  double control_of(int k) const {
    const mjtNum* range = m_.actuator_ctrlrange + 2 * k;
    const double control = start_.ctrl[k];
    return m_.actuator_ctrllimited[k] ? std::clamp(control, double{range[0]}, double{range[1]}) : control;
  }

  // A drive of fixed control is a constant, a spring and a damper: force = gain * control + bias.
  void read_actuator(int k) {
    const std::string where = at("actuator", mjOBJ_ACTUATOR, k);
    const mjtNum *bias = m_.actuator_biasprm + mjNBIAS * k, *gain = m_.actuator_gainprm + mjNGAIN * k;
    const double control = control_of(k);
    const bool has_bias = m_.actuator_biastype[k] != mjBIAS_NONE,
               is_affine = !has_bias || m_.actuator_biastype[k] == mjBIAS_AFFINE,
               is_plain = is_affine && m_.actuator_gaintype[k] == mjGAIN_FIXED && m_.actuator_dyntype[k] == mjDYN_NONE;
    const double b0 = has_bias ? bias[0] : 0, b1 = has_bias ? bias[1] : 0, b2 = has_bias ? bias[2] : 0;
    const bool is_driven = control != 0 && gain[0] != 0;
    if (is_affine && !is_driven && b0 == 0 && b1 == 0 && b2 == 0)
      return leave_out(where, "it", "its control is zero from start to end: the drive does nothing");
    const bool is_of_joint = m_.actuator_trntype[k] == mjTRN_JOINT && row_of_joint_[m_.actuator_trnid[2 * k]] >= 0;
    const double gear = m_.actuator_gear[6 * k];
    if (!is_plain || !is_of_joint || m_.actuator_forcelimited[k] || b1 > 0 || b2 > 0 || gear == 0)
      return leave_out(where, "it", "a scene has no drive that follows this law");
    const int joint = m_.actuator_trnid[2 * k], row = row_of_joint_[joint];
    Joint& driven = model_.joints[row].joint;
    if (!free_axis(driven)) return leave_out(where, "it", "drives a joint without an axis of its own");
    // gear (c + b1 gear q + b2 gear q') with c = gain * control + b0 and q = x + q(0): a second spring at the joint.
    const double constant = gain[0] * control + b0, stiffness = -b1 * gear * gear,
                 rest = stiffness > 0 ? constant / (-b1 * gear) - start_.qpos[m_.jnt_qposadr[joint]] : 0;
    driven.damping += -b2 * gear * gear;
    if (stiffness > 0) {
      driven.rest = (driven.stiffness * driven.rest + stiffness * rest) / (driven.stiffness + stiffness);
      driven.stiffness += stiffness;
    } else if (constant != 0) {
      Motor motor;
      motor.joint = row, motor.effort = constant * gear;
      model_.motors.push_back(motor);
    }
    leave_out(where, "its control",
              fmt::format("stays {:g}, as at the start: the drive becomes {}", control,
                          stiffness > 0 ? "a spring and a damper" : "a constant effort and a damper"));
  }

  std::string path_;
  const mjModel& m_;
  const mjData& start_;
  LinkModel model_;
  std::vector<int> row_of_joint_;  // by MuJoCo's joint: that of model_.joints which it alone is, or -1
};

}  // namespace

LinkModel read_with_mujoco(const std::string& path, const std::string& keyframe) {
  const mujoco_library::Model model = mujoco_library::read_file(path);
  take_switches(*model);
  const mujoco_library::Data start = mujoco_start(*model, path, keyframe);
  LinkModel read = Importer(path, *model, *start).read();
  if (model->nkey > 0 && keyframe.empty())
    read.left_out.add(path, fmt::format("{} keyframes", model->nkey),
                      fmt::format("are other starts; the model's own is taken. rigor import --keyframe {} takes one",
                                  keyframes_of(*model).front()));
  if (const std::string warnings = mujoco_library::take_warnings(); !warnings.empty())
    read.left_out.add(path, "MuJoCo's warning", warnings);
  return read;
}

}  // namespace rigor
