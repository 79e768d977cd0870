#include "adapters/bullet/bullet_world.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "adapters/bullet/bullet_matched.h"
#include "adapters/bullet/bullet_options.h"
#include "adapters/bullet/bullet_pair_laws.h"
#include "adapters/bullet/bullet_state.h"
#include "adapters/common/option_values.h"

namespace rigor::inline adapters {
namespace {

using bullet::to_bullet;
using bullet::to_rigor;

const std::map<std::string, int> kGyroscopicFlags = {{"implicit-body", BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_BODY},
                                                     {"implicit-world", BT_ENABLE_GYROSCOPIC_FORCE_IMPLICIT_WORLD},
                                                     {"explicit", BT_ENABLE_GYROSCOPIC_FORCE_EXPLICIT},
                                                     {"off", 0}};
constexpr int kCorners = 4;  // of a box's face
constexpr int kCollideWithAll = -1, kCollideWithNone = 0;

std::string gyroscopic_mode(const btRigidBody& body) {
  for (const auto& [name, flag] : kGyroscopicFlags) {
    if (body.getFlags() == flag) return name;
  }
  return fmt::format("flags {}", body.getFlags());
}

// m, of the largest ball inside about the body's centre; 0 where that centre may lie outside.
double inner_radius(const Shape& shape) {
  return std::visit(ForShapes{[](const Compound&) { return 0.0; }, [](const Convex&) { return 0.0; },
                              [](const Plane&) { return 0.0; }, [](const SurfaceShape&) { return 0.0; },
                              [](const auto& centred) { return centred.inradius(); }},
                    shape);
}

// A body that moves by more than its inner ball's radius in a step is stopped where that ball first touches another. It
// loses the rest of the step, and its bounce, so this is only for scenes without restitution. The stock track lets it
// pass through.
void stop_at_first_touch(btRigidBody& body, double radius) {
  body.setCcdMotionThreshold(radius);
  body.setCcdSweptSphereRadius(radius);
}

std::string on_off(bool on) { return on ? "on" : "off"; }

std::unique_ptr<btSequentialImpulseConstraintSolver> make_solver(const std::string& method, btDantzigSolver& dantzig) {
  if (method == "mlcp") return std::make_unique<btMLCPSolver>(&dantzig);
  return std::make_unique<btSequentialImpulseConstraintSolver>();
}

}  // namespace

BulletWorld::BulletWorld(const Scene& scene, const Settings& settings)
    : ArchivesState("bullet", fmt::format("{}", btGetVersion()), scene, settings),
      laws_(scene),
      loads_(scene),
      matched_(settings.track == Track::matched),
      bounces_(needs(scene, Feature::restitution)),
      is_soft_(needs(scene, Feature::soft_contact)),
      solver_(make_solver(settings.method, dantzig_)) {
  bullet::install_pair_laws();
  world_.setGravity(to_bullet(scene.gravity));
  apply(settings);
  if (matched_) match(scene, settings);
  rows_.reserve(scene.bodies.size());
  for (const Body& body : scene.bodies) add_body(body, settings);
  using Set = bullet::Joints::Set;
  joints_ = std::make_unique<bullet::Joints>(
      scene, [&](int body) -> btRigidBody& { return end_of_joint(body); },
      !matched_                   ? Set::as_shipped
      : settings.method == "mlcp" ? Set::for_direct_solver
                                  : Set::for_sweeps);
  joints_->enter(world_);
  keep_apart(scene);
}

// Each body holds a list of bodies that it passes through; Bullet asks both.
void BulletWorld::keep_apart(const Scene& scene) {
  for (const ContactPair& pair : scene.contact_pairs) {
    if (pair.law.collides || !can_meet(scene.bodies[pair.a], scene.bodies[pair.b])) continue;
    btRigidBody &a = end_of_joint(pair.a), &b = end_of_joint(pair.b);
    a.setIgnoreCollisionCheck(&b, true);
    b.setIgnoreCollisionCheck(&a, true);
  }
}

btRigidBody& BulletWorld::end_of_joint(int body) {
  if (body == kWorld || !rows_[static_cast<std::size_t>(body)].body) return ground_;
  return *rows_[static_cast<std::size_t>(body)].body;
}

void BulletWorld::apply(const Settings& settings) {
  btContactSolverInfo& solver = world_.getSolverInfo();
  if (matched_) {
    solver.m_restitutionVelocityThreshold = 0;  // m/s: slower impacts bounce too
    // m: no penetration is corrected by adding velocity; with soft contacts all, for theirs is the spring's.
    solver.m_splitImpulsePenetrationThreshold = is_soft_ ? -1e30 : 1e30;
    solver.m_maxGyroscopicForce = 1e30;  // N m: the explicit gyroscopic torque is not cut off
    // A box on a plane touches with all its corners at once; as shipped Bullet finds one a step, and the box tips over
    // it.
    configuration_.setPlaneConvexMultipointIterations(kCorners, kCorners);
  }
  if (const auto iterations = number_to_set(settings, bullet::kIterations))
    solver.m_numIterations = static_cast<int>(*iterations);
  if (const auto erp = number_to_set(settings, bullet::kErpOption)) solver.m_erp = *erp;
  const OptionInfo& cfm_option = settings.method == "mlcp" ? bullet::kDirectCfm : bullet::kCfm;
  if (const auto cfm = number_to_set(settings, cfm_option)) solver.m_globalCfm = *cfm;
  if (const auto split = word_to_set(settings, bullet::kSplitImpulse)) solver.m_splitImpulse = *split == "on";
}

// Values that follow from the scene if the run does not set them.
void BulletWorld::match(const Scene& scene, const Settings& settings) {
  if (!scene.joints.empty() && !is_named(settings, bullet::kErpOption)) world_.getSolverInfo().m_erp = bullet::kErp;
  if (settings.method == "mlcp" && !is_named(settings, bullet::kDirectCfm)) softness_ = bullet::softness(scene);
}

void BulletWorld::add_body(const Body& body, const Settings& settings) {
  Row& row = rows_.emplace_back();
  row.moves = !body.fixed;
  row.standing = {body.position, body.orientation, Vec3::Zero(), Vec3::Zero()};
  if (body.fixed && !body.collides) return;

  const bullet::PrincipalFrame frame = body.fixed ? bullet::PrincipalFrame{} : bullet::principal_frame(body.inertia);
  row.turned = frame.turned;
  row.R_PB = frame.R_BP.transpose();
  btCollisionShape* shape = body.collides ? bullet::add_shape(*body.shape, frame, !matched_, shapes_) : &no_shape_;
  const bool is_plane = body.collides && std::holds_alternative<Plane>(*body.shape);

  // A mass of zero is Bullet's word for fixed.
  btRigidBody::btRigidBodyConstructionInfo start(body.fixed ? 0 : body.mass, nullptr, shape, to_bullet(frame.moments));
  start.m_startWorldTransform.setIdentity();
  if (!is_plane) {
    const Mat3 R_WP = body.orientation.toRotationMatrix() * frame.R_BP;
    start.m_startWorldTransform = btTransform(to_bullet(R_WP), to_bullet(body.position));
  }
  row.body = std::make_unique<btRigidBody>(start);
  bullet::follow_laws(*row.body, laws_, static_cast<int>(rows_.size()) - 1);
  if (is_soft_ || (matched_ && body.shape && surface_in(*body.shape))) bullet::adjust_contacts(*row.body);
  if (row.moves) {
    row.body->setLinearVelocity(to_bullet(body.velocity));
    row.body->setAngularVelocity(to_bullet(body.angular_velocity));
    if (const auto gyroscopic = word_to_set(settings, bullet::kGyroscopic))
      row.body->setFlags(kGyroscopicFlags.at(*gyroscopic));
  }
  if (matched_) {
    if (row.moves) row.body->setActivationState(DISABLE_DEACTIVATION);
    row.body->setDamping(0, 0);
    // m: no impulse across a gap, which would brake a body before its bounce. Without restitution that impulse is
    // correct.
    if (bounces_) row.body->setContactProcessingThreshold(0);
    if (row.moves && body.collides && !bounces_ && !is_soft_) stop_at_first_touch(*row.body, inner_radius(*body.shape));
  }
  world_.addRigidBody(row.body.get(), btBroadphaseProxy::DefaultFilter,
                      body.collides ? kCollideWithAll : kCollideWithNone);
}

void BulletWorld::step(double dt) {
  if (!loads_.empty()) add_loads(dt);
  joints_->set_for_step(clock_.time(), dt);
  if (softness_ > 0) world_.getSolverInfo().m_globalCfm = softness_ * dt;
  // No sub-steps: with them Bullet would advance by multiples of 1/60 s for any dt.
  world_.stepSimulation(dt, 0);
  last_dt_ = dt;
  clock_.advance(dt);
  look_for_fallback();
}

// The direct solver hands a system that it cannot solve to sequential impulses, and counts it.
void BulletWorld::look_for_fallback() {
  auto* direct = dynamic_cast<btMLCPSolver*>(solver_.get());
  if (!direct) return;
  const bool gave_up = direct->getNumFallbacks() > 0;
  warning_ = gave_up ? "Bullet's direct solver found no solution and left the step to sequential impulses" : "";
  direct->setNumFallbacks(0);
}

void BulletWorld::add_loads(double dt) {
  const Wrenches& wrenches = loads_.over_step(*this, dt);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    if (!rows_[i].moves) continue;
    rows_[i].body->applyCentralForce(to_bullet(wrenches[i].force));  // in the world frame; cleared after the step
    rows_[i].body->applyTorque(to_bullet(wrenches[i].torque));
  }
}

void BulletWorld::read(Snapshot& out) const {
  out.time = clock_.time();
  const MutableBodyColumns columns = out.own(rows_.size(), true);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    if (!row.moves) {
      columns.set_body(i, row.standing);
      columns.set_rotation(i, matrix_of(row.standing.orientation));
      continue;
    }
    const btTransform& pose = row.body->getWorldTransform();
    columns.set_position(i, to_rigor(pose.getOrigin()));
    const Mat3 R_WP = to_rigor(pose.getBasis());
    if (row.turned) {
      const Mat3 R_WB = R_WP * row.R_PB;
      columns.set_orientation(i, Quat(R_WB));
      columns.set_rotation(i, R_WB);
    } else {
      columns.set_orientation(i, to_rigor(pose.getRotation()));
      columns.set_rotation(i, R_WP);
    }
    columns.set_velocity(i, to_rigor(row.body->getLinearVelocity()));
    columns.set_angular_velocity(i, to_rigor(row.body->getAngularVelocity()));
  }
}

std::vector<ReportedReaction> BulletWorld::reactions() const {
  return clock_.time() > 0 ? joints_->reactions() : std::vector<ReportedReaction>();
}

void BulletWorld::archive_state(StateArchive& archive) {
  unsigned long seed = solver_->getRandSeed();
  archive(clock_, last_dt_, warning_, loads_, *joints_, seed);
  solver_->setRandSeed(seed);
  bullet::archive_bodies(archive, world_);
  bullet::archive_contacts(archive, world_);
  bullet::archive_sleep(archive, world_);
}

const btRigidBody* BulletWorld::first_moving() const {
  for (const Row& row : rows_) {
    if (row.moves) return row.body.get();
  }
  return nullptr;
}

std::string BulletWorld::restitution_in_words() const {
  if (!bounces_) return "none in this scene";
  if (matched_)
    return "contacts act from the touch on, so that no impulse across a gap brakes a body before its bounce";
  return "as shipped a contact already brakes the speed that would close the last gap. The rebound depends on the "
         "position of the touch in a step, and does not converge as dt falls";
}

SettingsInForce BulletWorld::settings_in_force() const {
  // Bullet has no const getter for what its solver works with.
  const btContactSolverInfo& solver = const_cast<btDiscreteDynamicsWorld&>(world_).getSolverInfo();
  const btVector3 g = world_.getGravity();
  SettingsInForce in_force = {
      {"precision", sizeof(btScalar) == sizeof(double) ? "double" : "single"},
      {"solver", solver_->getSolverType() == BT_MLCP_SOLVER ? "mixed linear complementarity by Dantzig's pivoting"
                                                            : "sequential impulse"},
      {"iterations", fmt::format("{}", solver.m_numIterations)},
      {"gravity", fmt::format("{:g}, {:g}, {:g} m/s^2", g.x(), g.y(), g.z())},
      {"sub-steps", "none: one step of dt (as shipped, stepSimulation would advance by multiples of 1/60 s)"},
      {"erp", fmt::format("{:g}, contacts {:g}", solver.m_erp, solver.m_erp2)},
      {"cfm", softness_ > 0 ? fmt::format("{:g} 1/kg times dt", softness_) : fmt::format("{:g}", solver.m_globalCfm)},
      {"split impulse", on_off(solver.m_splitImpulse)},
      {"split impulse threshold",
       matched_ && is_soft_
           ? fmt::format("{:g} m: every overlap pushes, because that of a soft contact is its spring's",
                         solver.m_splitImpulsePenetrationThreshold)
       : matched_
           ? fmt::format("{:g} m: every overlap is moved out without adding speed, at the price of stacks that lean "
                         "sooner",
                         solver.m_splitImpulsePenetrationThreshold)
           : fmt::format("{:g} m: only overlaps beyond 4 cm are moved out, smaller ones are pushed out as speed",
                         solver.m_splitImpulsePenetrationThreshold)},
      {"restitution threshold", fmt::format("{:g} m/s", solver.m_restitutionVelocityThreshold)},
      {"restitution", restitution_in_words()},
      {"warm starting", on_off(solver.m_solverMode & SOLVER_USE_WARMSTARTING)},
      {"friction directions", solver.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS
                                  ? "two, the first along the sliding velocity"
                                  : "one, along the sliding velocity"},
      {"corners found a step",
       matched_ ? fmt::format("up to {}, of a box on a plane", kCorners) : "one, of a box on a plane"},
      {"contact breaking threshold", fmt::format("{:g} m", gContactBreakingThreshold)},
      {"springs and timed forces", "user forces, recomputed before each step"},
  };
  if (const btRigidBody* body = first_moving()) {  // all moving bodies are set alike
    in_force.emplace_back("gyroscopic", gyroscopic_mode(*body));
    in_force.emplace_back(
        "damping", fmt::format("linear {:g}, angular {:g}", body->getLinearDamping(), body->getAngularDamping()));
    in_force.emplace_back("sleeping",
                          body->getActivationState() == DISABLE_DEACTIVATION
                              ? "off"
                              : fmt::format("on, after {:g} s below {:g} m/s and {:g} rad/s", gDeactivationTime,
                                            body->getLinearSleepingThreshold(), body->getAngularSleepingThreshold()));
    in_force.emplace_back("continuous collision", body->getCcdMotionThreshold() > 0
                                                      ? "on, for a body that moves by more than its inner radius a step"
                                                      : "off");
    in_force.emplace_back("contact processing threshold", fmt::format("{:g} m", body->getContactProcessingThreshold()));
  }
  return in_force;
}

}  // namespace rigor::inline adapters
