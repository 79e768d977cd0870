#include "adapters/mujoco/mujoco_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "adapters/mujoco/mujoco_mjcf.h"
#include "adapters/mujoco/mujoco_servos.h"
#include "adapters/mujoco/mujoco_values.h"
#include "core/dynamics/model/loads/loads.h"

namespace rigor::inline adapters {
namespace {

std::vector<Motor> servos_of(const Scene& scene) {
  std::vector<Motor> servos;
  std::copy_if(scene.motors.begin(), scene.motors.end(), std::back_inserter(servos),
               [](const Motor& motor) { return motor.servo.has_value(); });
  return servos;
}

// What is left for the loads that MuJoCo does not know: the timed forces, and servos that it is not to have.
Scene only_forces(const Scene& scene, const Settings& settings) {
  Scene left;
  left.bodies = scene.bodies, left.forces = scene.forces, left.joints = scene.joints;
  for (Joint& joint : left.joints) joint.stiffness = joint.damping = 0;
  if (!has_native_servos(scene, settings)) left.motors = servos_of(scene);
  return left;
}

std::vector<Motor> motors_of_effort(const Scene& scene) {
  std::vector<Motor> motors;
  for (const Motor& motor : scene.motors) {
    if (motor.gives_effort()) motors.push_back(motor);
  }
  return motors;
}

std::string solref_in_words(const mjtNum* solref, const mjtNum* solimp) {
  return fmt::format("solref {:g} {:g}, solimp {:g} {:g} {:g}", solref[0], solref[1], solimp[0], solimp[1], solimp[2]);
}

}  // namespace

MujocoWorld::MujocoWorld(const Scene& scene, const Settings& settings)
    : ArchivesState("mujoco", fmt::format("{}", mj_version()), scene, settings),
      scene_(only_forces(scene, settings)),
      tree_(spanning_tree(scene)),
      made_((mujoco_library::start(), mujoco_model(scene, tree_, settings))),
      data_(mj_makeData(made_.model.get())),
      loads_(scene_),
      motors_(motors_of_effort(scene)),
      servos_(has_native_servos(scene, settings) ? servos_of(scene) : std::vector<Motor>()),
      has_servos_(!servos_of(scene).empty()),
      matched_(settings.track == Track::matched),
      is_jointed_(!scene.joints.empty()),
      said_(scene, tree_, settings.method) {
  if (!data_) throw std::runtime_error("MuJoCo has no memory for the scene's contacts and constraints");
  mujoco_set(*made_.model, mujoco_contact_values(settings));
  // Constants that follow from the inertias, worked out at the pose of t = 0, which the data then holds again.
  mj_setConst(made_.model.get(), data_.get());
  mj_resetData(made_.model.get(), data_.get());
  const std::vector<double> velocities = mujoco_velocities(scene, tree_, made_);
  std::copy(velocities.begin(), velocities.end(), data_->qvel);
  mujoco_library::take_warnings();
  body_of_geom_.assign(static_cast<std::size_t>(made_.model->ngeom), kWorld);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const int body = static_cast<int>(i);
    for (int part = 0;; ++part) {
      const int geom = mj_name2id(made_.model.get(), mjOBJ_GEOM, mjcf_geom_name(body, part).c_str());
      if (geom < 0) break;
      body_of_geom_[static_cast<std::size_t>(geom)] = body;
    }
  }
}

// Positions, velocities and the start of the solver's next iteration: nothing else of MuJoCo's outlives a step.
void MujocoWorld::archive_state(StateArchive& archive) {
  const auto size = [](int count) { return static_cast<std::size_t>(count); };
  archive(clock_, lost_, solver_warning_, loads_, data_->time);
  archive.numbers(data_->qpos, size(made_.model->nq));
  archive.numbers(data_->qvel, size(made_.model->nv));
  archive.numbers(data_->qacc_warmstart, size(made_.model->nv));
  if (archive.restores()) is_step_in_data_ = false;  // the poses of jointed bodies are worked out when they are read
}

void MujocoWorld::step(double dt) {
  if (!lost_) {
    made_.model->opt.timestep = dt;
    if (matched_ && dt != stiff_dt_) {
      mujoco_set(*made_.model, mujoco_stiff_values(), dt);
      stiff_dt_ = dt;
    }
    apply_loads(dt);
    mj_step(made_.model.get(), data_.get());
    look_for_warnings();
    is_step_in_data_ = true;
  }
  clock_.advance(dt);
}

// Force and torque about the centre of mass, in W in MuJoCo as here; they stay until they are written again.
void MujocoWorld::apply_loads(double dt) {
  if (!loads_.empty()) {
    const Wrenches& wrenches = loads_.over_step(*this, dt);
    for (std::size_t i = 0; i < made_.body.size(); ++i) {
      if (made_.body[i] < 0) continue;
      Eigen::Map<Vec3>(data_->xfrc_applied + 6 * made_.body[i]) = wrenches[i].force;
      Eigen::Map<Vec3>(data_->xfrc_applied + 6 * made_.body[i] + 3) = wrenches[i].torque;
    }
  }
  const std::vector<double> controls = mujoco_controls(servos_, clock_.time());
  std::copy(controls.begin(), controls.end(), data_->ctrl);
  for (const Motor& motor : motors_) data_->qfrc_applied[made_.coordinate[motor.joint].velocity] = 0;
  for (const Motor& motor : motors_) {
    const MujocoModel::Coordinate& at = made_.coordinate[motor.joint];
    data_->qfrc_applied[at.velocity] += at.sign * motor.mean_effort(clock_.time(), dt);
  }
}

// Where a number is not finite, or over 1e10, MuJoCo sets the world back to its start and goes on: it only counts that.
void MujocoWorld::look_for_warnings() {
  solver_warning_ = mujoco_library::take_warnings();
  const auto count = [&](mjtWarning kind) { return data_->warning[kind].number; };
  if (count(mjWARN_BADQPOS) + count(mjWARN_BADQVEL) + count(mjWARN_BADQACC) > 0) {
    lost_ = true;
    solver_warning_ = "a number passed 1e10 or was not finite: MuJoCo sets such a world back to its start";
  }
  if (count(mjWARN_CONTACTFULL) + count(mjWARN_CNSTRFULL) > 0)
    solver_warning_ = "MuJoCo had no room for all contacts and left some out";
}

// Of a free body: velocity in W, but angular velocity in B.
void MujocoWorld::read_free(MutableBodyColumns out, std::size_t i) const {
  const mjModel& model = *made_.model;
  const int id = made_.body[i];
  const mjtNum* q = data_->qpos + model.jnt_qposadr[model.body_jntadr[id]];
  const mjtNum* v = data_->qvel + model.body_dofadr[id];
  const Quat orientation(q[3], q[4], q[5], q[6]);
  out.set_position(i, {q[0], q[1], q[2]});
  out.set_orientation(i, orientation);
  out.set_velocity(i, {v[0], v[1], v[2]});
  out.set_angular_velocity(i, matrix_of(orientation) * Vec3(v[3], v[4], v[5]));
}

void MujocoWorld::read_jointed(MutableBodyColumns out, std::size_t i) const {
  const int id = made_.body[i];
  const mjtNum *p = data_->xpos + 3 * id, *q = data_->xquat + 4 * id;
  mjtNum velocity[6];  // angular, then linear; of the centre of mass, in W
  mj_objectVelocity(made_.model.get(), data_.get(), mjOBJ_BODY, id, velocity, 0);
  out.set_position(i, {p[0], p[1], p[2]});
  out.set_orientation(i, {q[0], q[1], q[2], q[3]});
  out.set_velocity(i, {velocity[3], velocity[4], velocity[5]});
  out.set_angular_velocity(i, {velocity[0], velocity[1], velocity[2]});
}

// Uses the data that the step left, before they are computed for the new positions.
void MujocoWorld::note_reactions() const {
  if (is_asked_ && is_step_in_data_ && !lost_) reactions_ = said_.after_step(*made_.model, *data_, made_);
  is_step_in_data_ = false;
}

std::vector<ReportedReaction> MujocoWorld::reactions() const {
  note_reactions();
  return reactions_;
}

// Those of the step's start, which a step leaves in the data. The force is that on the second geom, in the contact's
// frame, whose rows are in W; the first of them is the normal, from the first geom to the second.
std::vector<ReportedContact> MujocoWorld::contacts() const {
  std::vector<ReportedContact> contacts;
  if (clock_.time() == 0 || lost_) return contacts;
  for (int k = 0; k < data_->ncon; ++k) {
    const mjContact& at = data_->contact[k];
    mjtNum wrench[6];  // force, then torque
    mj_contactForce(made_.model.get(), data_.get(), k, wrench);
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> frame(at.frame);
    const auto body = [&](int geom) { return body_of_geom_[static_cast<std::size_t>(geom)]; };
    contacts.push_back({body(at.geom1), body(at.geom2), Vec3(at.pos[0], at.pos[1], at.pos[2]), frame.row(0), at.dist,
                        frame.transpose() * Vec3(wrench[0], wrench[1], wrench[2])});
  }
  return contacts;
}

void MujocoWorld::read(Snapshot& out) const {
  note_reactions();
  out.time = clock_.time();
  const MutableBodyColumns columns = out.own(scene_.bodies.size());
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const BodyState nowhere = {Vec3::Constant(kNaN), Quat(kNaN, kNaN, kNaN, kNaN), Vec3::Constant(kNaN),
                             Vec3::Constant(kNaN)};
  if (is_jointed_ && !lost_) {  // where the bodies are follows from the joints; a step leaves them where it began
    mj_kinematics(made_.model.get(), data_.get());
    mj_comPos(made_.model.get(), data_.get());
    mj_comVel(made_.model.get(), data_.get());
  }
  for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
    const Body& body = scene_.bodies[i];
    if (body.fixed) {
      columns.set_body(i, {body.position, body.orientation, Vec3::Zero(), Vec3::Zero()});
    } else if (lost_) {
      columns.set_body(i, nowhere);
    } else {
      is_jointed_ ? read_jointed(columns, i) : read_free(columns, i);
    }
  }
}

SettingsInForce MujocoWorld::settings_in_force() const {
  const mjModel& model = *made_.model;
  const mjOption& option = model.opt;
  static const char* kIntegrators[] = {"Euler, semi-implicit", "RK4", "implicit in velocity"};
  static const char* kSolvers[] = {"PGS", "CG", "Newton"};
  SettingsInForce in_force = {
      {"precision", sizeof(mjtNum) == sizeof(double) ? "double" : "single"},
      {"integrator", kIntegrators[option.integrator]},
      {"gravity", fmt::format("{:g}, {:g}, {:g} m/s^2", option.gravity[0], option.gravity[1], option.gravity[2])},
      {"solver",
       fmt::format("{}, at most {} iterations to {:g}", kSolvers[option.solver], option.iterations, option.tolerance)},
      {"friction cone", option.cone == mjCONE_ELLIPTIC ? "elliptic"
                                                       : "pyramidal: along its diagonal it brakes with 0.71 of the "
                                                         "force of the cone, and a slide goes 1.41 times as far"},
      {"impratio", fmt::format("{:g}: friction is that much stiffer than contact", option.impratio)},
      {"springs", "tendons, evaluated at each stage"},
      {"timed forces and motors", "user forces, set before each step"},
  };
  if (has_servos_)
    in_force.emplace_back("servos", model.nu > 0 ? "MuJoCo's actuators, by each evaluation's state"
                                                 : "efforts that Rigor computes from the state at each step's start");
  if (model.ngeom > 0) {
    in_force.emplace_back("contacts", solref_in_words(model.geom_solref, model.geom_solimp));
    in_force.emplace_back("restitution", fmt::format("by the damping ratio {:g} of contacts", model.geom_solref[1]));
    if (model.geom_margin[0] > 0)
      in_force.emplace_back("contact margin", fmt::format("{:g} m: bodies rest that far apart", model.geom_margin[0]));
  }
  const char* when = matched_ && stiff_dt_ == 0 ? " until the first step" : "";
  if (model.neq > 0) in_force.emplace_back("loops", solref_in_words(model.eq_solref, model.eq_solimp) + when);
  const int limited =
      static_cast<int>(std::find(model.jnt_limited, model.jnt_limited + model.njnt, 1) - model.jnt_limited);
  if (limited < model.njnt) {  // all are set alike
    in_force.emplace_back(
        "limits", solref_in_words(model.jnt_solref + mjNREF * limited, model.jnt_solimp + mjNIMP * limited) + when);
  }
  return in_force;
}

}  // namespace rigor::inline adapters
