#include "adapters/ode/ode_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <limits>

#include "adapters/common/option_values.h"
#include "adapters/ode/ode_library.h"
#include "adapters/ode/ode_matched.h"
#include "adapters/ode/ode_options.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline adapters {
namespace {

// m/s, rad/s, N and N m. No motion has such numbers; soon after, ODE would find one that is not finite and abort the
// process.
constexpr double kRunaway = 1e50;

Vec3 vector_of(const dReal* v) { return {v[0], v[1], v[2]}; }

bool is_runaway(const dReal* v) {  // true for "not a number", too
  return !(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] < kRunaway * kRunaway);
}

// ODE's quaternion is (w, x, y, z), body to world, as ours.
void copy_to(const Quat& q, dQuaternion out) { out[0] = q.w(), out[1] = q.x(), out[2] = q.y(), out[3] = q.z(); }

dMass mass_of(const Body& body) {
  // About the centre of mass (at the body's origin in both), in the body frame in both; ODE takes any symmetric matrix.
  // ODE's order of the products is 12, 13, 23; its sign is that of the matrix entry, as ours.
  dMass mass;
  const Mat3& I = body.inertia;
  dMassSetParameters(&mass, body.mass, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2));
  return mass;
}

// Ours and ODE's: a box by full edge lengths; a capsule along z by the length of the cylinder alone, without its caps;
// a plane by n · x = d with the solid behind it.
struct MakeGeom {
  dSpaceID space;
  OdePolyhedra& polyhedra;

  // A compound, whose parts are made, and shapes that ODE lacks: no feature of its contacts names them.
  template <typename Other>
  requires(!std::is_base_of_v<SurfaceShape, Other>) dGeomID operator()(const Other&) const { return nullptr; }
  dGeomID operator()(const Convex& c) const {
    polyhedra.hulls.push_back(std::make_unique<OdeHull>(*c.hull));
    return polyhedra.hulls.back()->add_to(space);
  }
  // ODE has height fields of its own, whose cells it divides in its own way; here both are the triangles of the scene.
  dGeomID operator()(const SurfaceShape& on) const {
    polyhedra.surfaces.push_back(std::make_unique<OdeTriangles>(*on.surface));
    return polyhedra.surfaces.back()->add_to(space);
  }
  dGeomID operator()(const Cylinder& c) const { return dCreateCylinder(space, c.radius, c.length); }
  dGeomID operator()(const Sphere& s) const { return dCreateSphere(space, s.radius); }
  dGeomID operator()(const Box& b) const { return dCreateBox(space, b.size.x(), b.size.y(), b.size.z()); }
  dGeomID operator()(const Capsule& c) const { return dCreateCapsule(space, c.radius, c.length); }
  dGeomID operator()(const Plane& p) const {
    return dCreatePlane(space, p.normal.x(), p.normal.y(), p.normal.z(), p.offset);
  }
};

// The number on which the method `auto` decides.
bool has_too_many_for_worldstep(const Scene& scene) {
  const auto can_touch = [](const Body& body) { return body.collides && !body.fixed; };
  return std::count_if(scene.bodies.begin(), scene.bodies.end(), can_touch) > kMostForWorldStep;
}

bool has_native_servos(const Settings& settings) { return word_option(settings, kOdeServo) == "native"; }

Scene without_servos(Scene scene) {
  std::erase_if(scene.motors, [](const Motor& motor) { return motor.servo.has_value(); });
  return scene;
}

// ODE multiplies the coefficients of all three axes by the normal force, or none; an infinite one must not be.
void refuse_infinite_friction_that_rolls(const Scene& scene) {
  const auto is_both = [](const ContactLaw& law) { return law.resists_turning() && law.friction == kInfiniteFriction; };
  if (!any_law(scene, is_both)) return;
  throw EngineFailure(FailureKind::unsupported,
                      "ODE's rolling and torsional friction need a finite coefficient of friction beside them");
}

}  // namespace

OdeWorld::OdeWorld(const Scene& scene, const Settings& settings)
    : ArchivesState("ode", dODE_VERSION, scene, settings),
      laws_(scene),
      loads_(has_native_servos(settings) ? without_servos(scene) : scene),
      can_touch_(anything_can_touch(scene)),
      matched_(settings.track == Track::matched),
      by_size_(settings.method == "auto"),
      quick_(settings.method == "quickstep" || (by_size_ && has_too_many_for_worldstep(scene))) {
  refuse_infinite_friction_that_rolls(scene);
  ode_library::start();
  world_ = dWorldCreate();
  moving_ = dSweepAndPruneSpaceCreate(nullptr, dSAP_AXES_XYZ);
  fixed_ = dSimpleSpaceCreate(nullptr);
  contacts_ = dJointGroupCreate(0);
  dWorldSetGravity(world_, scene.gravity.x(), scene.gravity.y(), scene.gravity.z());
  apply(settings, scene);
  for (const Body& body : scene.bodies) add_body(body, settings);
  joints_.emplace(scene, world_, bodies_, settings.track, has_native_servos(settings));
}

OdeWorld::~OdeWorld() {
  dJointGroupDestroy(contacts_);
  dSpaceDestroy(moving_);  // with the geometries in it
  dSpaceDestroy(fixed_);
  dWorldDestroy(world_);
}

void OdeWorld::apply(const Settings& settings, const Scene& scene) {
  if (matched_) {
    dWorldSetAutoDisableFlag(world_, 0);
    dWorldSetDamping(world_, 0, 0);
  }
  contact_erp_ = number_to_set(settings, kOdeErp).value_or(dWorldGetERP(world_));
  const bool own_erp = matched_ && !scene.joints.empty() && !is_named(settings, kOdeErp);
  dWorldSetERP(world_, own_erp ? kMatchedJointErp : contact_erp_);
  if (const auto cfm = number_to_set(settings, kOdeCfm)) dWorldSetCFM(world_, *cfm);
  if (matched_ && (can_touch_ || !scene.joints.empty()) && !is_named(settings, kOdeCfm)) {
    softness_ = matched_softness(scene), softness_share_ = matched_softness_share(scene);
  }
  if (const auto iterations = number_to_set(settings, kOdeIterations))
    dWorldSetQuickStepNumIterations(world_, static_cast<int>(*iterations));
  if (const auto sor = number_to_set(settings, kOdeSor)) dWorldSetQuickStepW(world_, *sor);
}

void OdeWorld::add_body(const Body& body, const Settings& settings) {
  dBodyID id = nullptr;
  if (!body.fixed) {
    id = dBodyCreate(world_);
    const dMass mass = mass_of(body);
    dBodySetMass(id, &mass);
    dQuaternion q;
    copy_to(body.orientation, q);
    dBodySetPosition(id, body.position.x(), body.position.y(), body.position.z());
    dBodySetQuaternion(id, q);
    // Both velocities are in the world frame, of the centre of mass, in ODE as here.
    dBodySetLinearVel(id, body.velocity.x(), body.velocity.y(), body.velocity.z());
    dBodySetAngularVel(id, body.angular_velocity.x(), body.angular_velocity.y(), body.angular_velocity.z());
    if (const auto rotation = word_to_set(settings, kOdeRotation))
      dBodySetFiniteRotationMode(id, *rotation == "finite");
    if (const auto gyroscopic = word_to_set(settings, kOdeGyroscopic)) dBodySetGyroscopicMode(id, *gyroscopic == "on");
  }
  bodies_.push_back(id);
  standing_.push_back({body.position, body.orientation, Vec3::Zero(), Vec3::Zero()});
  if (can_touch_ && body.collides) add_geometry(body, id);
}

void OdeWorld::add_geometry(const Body& body, dBodyID moving) {
  for_each_part(*body.shape, [&](const Shape& shape, const BodyPose& pose) { add_part(body, shape, pose, moving); });
}

void OdeWorld::add_part(const Body& body, const Shape& shape, const BodyPose& pose, dBodyID moving) {
  const dGeomID geom = std::visit(MakeGeom{moving ? moving_ : fixed_, polyhedra_}, shape);
  if (!geom) return;
  const auto index = static_cast<std::intptr_t>(bodies_.size()) - 1;
  dGeomSetData(geom, reinterpret_cast<void*>(index));
  dQuaternion q;
  if (moving) {
    geoms_.push_back(geom);
    dGeomSetBody(geom, moving);
    if (!std::holds_alternative<Compound>(*body.shape)) return;
    copy_to(pose.orientation, q);
    dGeomSetOffsetPosition(geom, pose.position.x(), pose.position.y(), pose.position.z());
    dGeomSetOffsetQuaternion(geom, q);
  } else if (!std::holds_alternative<Plane>(shape)) {  // a plane is given in the world frame, in ODE as here
    const BodyPose in_W = BodyPose{body.position, body.orientation} * pose;
    copy_to(in_W.orientation, q);
    dGeomSetPosition(geom, in_W.position.x(), in_W.position.y(), in_W.position.z());
    dGeomSetQuaternion(geom, q);
  }
}

void OdeWorld::step(double dt) {
  if (!lost_ && !loads_.empty()) add_loads(dt);
  if (!lost_) advance(dt);
  clock_.advance(dt);
  if (!lost_) lost_ = runs_away();
  if (lost_)
    solver_warning_ = fmt::format("a speed or force passed {:g}: ODE was stopped before it would abort", kRunaway);
}

bool OdeWorld::runs_away() const {
  return std::any_of(bodies_.begin(), bodies_.end(), [](dBodyID body) {
    return body && (is_runaway(dBodyGetLinearVel(body)) || is_runaway(dBodyGetAngularVel(body)));
  });
}

void OdeWorld::set_cfm(double cfm) {
  dWorldSetCFM(world_, cfm);
  joints_->set_cfm(cfm);
}

void OdeWorld::advance(double dt) {
  if (softness_ > 0) set_cfm(softness_ * dt);
  joints_->drive(clock_.time() + 0.5 * dt);
  joints_->aim(clock_.time(), dt);
  step_ = dt;
  if (can_touch_) find_contacts();
  const int done = quick_ ? quick_step(dt) : dWorldStep(world_, dt);
  if (can_touch_) dJointGroupEmpty(contacts_);
  solver_warning_ = ode_library::take_messages();
  if (solver_warning_.starts_with("LCP")) {
    solver_warning_ = fmt::format(
        "ODE's direct solver gave up ({}): bodies have more contacts than they need, so its equations have no unique "
        "solution. The forces of that step are wrong",
        solver_warning_);
  }
  if (!done) solver_warning_ = "ODE had no memory for the step";
}

// QuickStep shuffles its constraints with a random sequence that is global to the process. Each world continues its own
// sequence, so that a run gives the same bits after any other run.
int OdeWorld::quick_step(double dt) {
  dRandSetSeed(random_seed_);
  const int done = dWorldQuickStep(world_, dt);
  random_seed_ = dRandGetSeed();
  return done;
}

void OdeWorld::add_loads(double dt) {
  const Wrenches& wrenches = loads_.over_step(*this, dt);
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i]) continue;
    const auto& [force, torque] = wrenches[i];
    if (is_runaway(force.data()) || is_runaway(torque.data())) lost_ = true;
    // In the world frame; ODE clears both after the step.
    dBodyAddForce(bodies_[i], force.x(), force.y(), force.z());
    dBodyAddTorque(bodies_[i], torque.x(), torque.y(), torque.z());
  }
}

void OdeWorld::read(Snapshot& out) const {
  out.time = clock_.time();
  const MutableBodyColumns columns = out.own(bodies_.size());
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const BodyState nowhere = {Vec3::Constant(kNaN), Quat(kNaN, kNaN, kNaN, kNaN), Vec3::Constant(kNaN),
                             Vec3::Constant(kNaN)};
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (!bodies_[i]) {
      columns.set_body(i, standing_[i]);
      continue;
    }
    if (lost_) {
      columns.set_body(i, nowhere);
      continue;
    }
    const dReal* q = dBodyGetQuaternion(bodies_[i]);
    columns.set_position(i, vector_of(dBodyGetPosition(bodies_[i])));
    columns.set_orientation(i, {q[0], q[1], q[2], q[3]});
    columns.set_velocity(i, vector_of(dBodyGetLinearVel(bodies_[i])));
    columns.set_angular_velocity(i, vector_of(dBodyGetAngularVel(bodies_[i])));
  }
}

std::vector<ReportedReaction> OdeWorld::reactions() const {
  return clock_.time() > 0 ? joints_->reactions() : std::vector<ReportedReaction>();
}

std::string OdeWorld::erp_in_words() const {
  std::string words = fmt::format("{:g}", dWorldGetERP(world_));
  if (!joints_->empty()) words += ": the share of a joint's gap that one step closes, by a speed that stays";
  if (!can_touch_) return words;
  if (!joints_->empty()) words += fmt::format("; contacts {:g}", contact_erp_);
  return words +
         ": the share of an overlap that one step pushes out, by a speed that stays. A body without bounce thus pops "
         "up. With 0 bodies would sink";
}

std::string OdeWorld::cfm_in_words() const {
  if (softness_ == 0) return fmt::format("{:g}", dWorldGetCFM(world_));
  return fmt::format(
      "{:.3g} 1/kg x dt, {:g} of the heaviest body's 1/mass. With less, the direct solver fails where a body has more "
      "contacts or joints than it needs. With more, these are soft",
      softness_, softness_share_);
}

std::string OdeWorld::solver_in_words() const {
  if (!quick_) return "worldstep (Dantzig)";
  return by_size_ ? fmt::format("quickstep (SOR), for more than {} bodies can touch", kMostForWorldStep)
                  : "quickstep (SOR)";
}

SettingsInForce OdeWorld::settings_in_force() const {
  dVector3 g;
  dWorldGetGravity(world_, g);
  SettingsInForce in_force = {
      {"precision", dCheckConfiguration("ODE_double_precision") ? "double" : "single"},
      {"solver", solver_in_words()},
      {"gravity", fmt::format("{:g}, {:g}, {:g} m/s^2", g[0], g[1], g[2])},
      {"erp", erp_in_words()},
      {"cfm", cfm_in_words()},
      {"damping",
       fmt::format("linear {:g}, angular {:g}", dWorldGetLinearDamping(world_), dWorldGetAngularDamping(world_))},
      {"auto-disable", dWorldGetAutoDisableFlag(world_) ? "on" : "off"},
      {"largest angular speed", fmt::format("{:g} rad/s", dWorldGetMaxAngularSpeed(world_))},
      {"contact correcting speed", fmt::format("at most {:g} m/s", dWorldGetContactMaxCorrectingVel(world_))},
      {"contact surface layer", fmt::format("{:g} m", dWorldGetContactSurfaceLayer(world_))},
      {"friction", matched_
                       ? "pyramid, its first direction along the sliding velocity, so that it brakes as the cone does"
                       : "pyramid, its directions chosen by the engine. Along its diagonal it brakes with sqrt(2) of "
                         "the force, and a slide ends after 0.71 of its way"},
      {"bounce threshold", fmt::format("{:g} m/s", bounce_threshold())},
      {"springs and timed forces", "user forces, recomputed before each step"},
  };
  if (quick_) {
    in_force.emplace_back("iterations", fmt::format("{}", dWorldGetQuickStepNumIterations(world_)));
    in_force.emplace_back("sor", fmt::format("{:g}", dWorldGetQuickStepW(world_)));
  }
  const SettingsInForce of_joints = joints_->settings_in_force();
  in_force.insert(in_force.end(), of_joints.begin(), of_joints.end());
  for (const dBodyID body : bodies_) {
    if (!body) continue;  // all moving bodies are set alike
    in_force.emplace_back("gyroscopic", dBodyGetGyroscopicMode(body) ? "on, implicit" : "off");
    in_force.emplace_back("rotation", dBodyGetFiniteRotationMode(body) ? "finite" : "infinitesimal");
    break;
  }
  return in_force;
}

}  // namespace rigor::inline adapters
