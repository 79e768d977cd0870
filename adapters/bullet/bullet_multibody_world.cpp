#include "adapters/bullet/bullet_multibody_world.h"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/bullet/bullet_options.h"
#include "adapters/common/option_values.h"

namespace rigor::inline adapters {
namespace {

using bullet::to_bullet;
using bullet::to_rigor;

constexpr bool kMaySleep = false;
constexpr double kUnlimited = 1e30;
constexpr int kCorners = 4;  // of a box's face

}  // namespace

BulletMultibodyWorld::BulletMultibodyWorld(const Scene& scene, const Settings& settings)
    : rows_(scene.bodies.size()), loads_(scene), coordinates_(scene.joints.size()), shapes_(scene) {
  world_.setGravity(to_bullet(scene.gravity));
  btContactSolverInfo& solver = world_.getSolverInfo();
  solver.m_numIterations = static_cast<int>(number_option(settings, bullet::kIterations));
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Body& body = scene.bodies[i];
    Row& row = rows_[i];
    row.moves = !body.fixed;
    row.state = {body.position, body.orientation, Vec3::Zero(), Vec3::Zero()};
    if (!row.moves) continue;
    row.frame = bullet::principal_frame(body.inertia);
    row.q_WP_start = (body.orientation * Quat(row.frame.R_BP)).normalized();
  }
  for (const bullet::Tree& tree : bullet::trees_of(scene)) add_tree(scene, tree, settings.track == Track::matched);
  const bool matched = settings.track == Track::matched;
  add_shapes(scene, matched);
  add_limits(scene, matched);
  add_motors(scene);
  read_bodies();
}

void BulletMultibodyWorld::add_shapes(const Scene& scene, bool matched) {
  shapes_.enter(world_);
  if (anything_can_touch(scene)) {
    // A box on a plane touches with all its corners at once. As shipped Bullet finds one of them in a step.
    if (matched) configuration_.setPlaneConvexMultipointIterations(kCorners, kCorners);
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      const Body& body = scene.bodies[i];
      const Row& row = rows_[i];
      const int index = static_cast<int>(i);
      if (!body.collides) continue;
      if (row.moves) {
        shapes_.add_moving(world_, body, index, row.frame, *row.tree, row.link, !matched);
      } else {
        shapes_.add_fixed(world_, body, index, !matched);
      }
    }
  }
  for (const auto& tree : trees_) shapes_.complete(world_, *tree);
}

// Bullet pushes back a share "erp" of an overshoot per step, by a speed that stays; on the matched track it is 0. The
// share of an overlap of bodies is m_erp2. The stock limit has an impulse of at most 100 N s or N m s.
void BulletMultibodyWorld::add_limits(const Scene& scene, bool matched) {
  if (matched) world_.getSolverInfo().m_erp = 0;
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    const Joint& joint = scene.joints[k];
    if (!joint.has_limits()) continue;
    const Coordinate& at = coordinates_[k];
    const double low = std::max(at.sign > 0 ? joint.lower : -joint.upper, -kUnlimited),
                 high = std::min(at.sign > 0 ? joint.upper : -joint.lower, kUnlimited);
    limits_.push_back(std::make_unique<btMultiBodyJointLimitConstraint>(at.tree, at.link, low, high));
    if (matched) limits_.back()->setMaxAppliedImpulse(kUnlimited);
    world_.addMultiBodyConstraint(limits_.back().get());
  }
}

void BulletMultibodyWorld::add_motors(const Scene& scene) {
  for (const Motor& motor : scene.motors) {
    if (!motor.speed) continue;  // an effort is one of the loads
    const Coordinate& at = coordinates_[static_cast<std::size_t>(motor.joint)];
    drives_.push_back({motor, std::make_unique<btMultiBodyJointMotor>(at.tree, at.link, at.sign * *motor.speed, 0)});
    world_.addMultiBodyConstraint(drives_.back().row.get());
  }
}

void BulletMultibodyWorld::set_motors(double dt) {
  for (const Drive& drive : drives_) {
    const double share = share_of_step(drive.motor.from, drive.motor.until, clock_.time(), dt);
    drive.row->setMaxAppliedImpulse(drive.motor.most * share * dt);  // N s, N m s; 0 without impulse
  }
}

BulletMultibodyWorld::~BulletMultibodyWorld() {
  for (const Drive& drive : drives_) world_.removeMultiBodyConstraint(drive.row.get());
  for (const auto& limit : limits_) world_.removeMultiBodyConstraint(limit.get());
  shapes_.leave(world_);
  for (const auto& tree : trees_) world_.removeMultiBody(tree.get());
}

void BulletMultibodyWorld::add_tree(const Scene& scene, const bullet::Tree& tree, bool matched) {
  int links = 0;
  for (const bullet::Branch& branch : tree.branches)
    links += bullet::links_of(scene.joints[static_cast<std::size_t>(branch.joint)]);
  const bool floats = tree.base != kWorld;
  const auto base = static_cast<std::size_t>(tree.base);
  const double mass = floats ? scene.bodies[base].mass : 0;
  const Vec3 moments = floats ? rows_[base].frame.moments : Vec3(Vec3::Zero());
  trees_.push_back(std::make_unique<btMultiBody>(links, mass, to_bullet(moments), !floats, kMaySleep));
  body_of_link_.emplace_back(links + 1, kWorld);
  btMultiBody& made = *trees_.back();
  if (floats) {
    const Body& body = scene.bodies[base];
    rows_[base].tree = &made;
    body_of_link_.back()[0] = tree.base;
    made.setBasePos(to_bullet(body.position));
    made.setWorldToBaseRot(to_bullet(rows_[base].q_WP_start.conjugate()));
  }
  int link = 0;
  for (const bullet::Branch& branch : tree.branches) {
    add_branch(scene, branch, made, link);
    link += bullet::links_of(scene.joints[static_cast<std::size_t>(branch.joint)]);
  }
  made.finalizeMultiDof();
  if (floats) {
    made.setBaseVel(to_bullet(scene.bodies[base].velocity));
    made.setBaseOmega(to_bullet(scene.bodies[base].angular_velocity));
  }
  for (const bullet::Branch& branch : tree.branches)
    bullet::set_velocities(made, rows_[static_cast<std::size_t>(branch.body)].link,
                           scene.joints[static_cast<std::size_t>(branch.joint)], ends_at_start(scene, branch));
  if (matched) {
    made.setLinearDamping(0), made.setAngularDamping(0);
    made.setMaxCoordinateVelocity(kUnlimited);  // rad/s, m/s: as shipped a faster joint is held back
  }
  world_.addMultiBody(&made);
}

void BulletMultibodyWorld::add_branch(const Scene& scene, const bullet::Branch& branch, btMultiBody& tree,
                                      int first_link) {
  const Joint& joint = scene.joints[static_cast<std::size_t>(branch.joint)];
  Row& row = rows_[static_cast<std::size_t>(branch.body)];
  row.tree = &tree, row.link = first_link + bullet::links_of(joint) - 1;
  body_of_link_.back()[static_cast<std::size_t>(row.link) + 1] = branch.body;
  coordinates_[static_cast<std::size_t>(branch.joint)] = {&tree, row.link, joint.b == branch.body ? 1.0 : -1.0};
  hanging_.emplace_back(branch.joint, HangingJoint(scene, branch.joint, branch.body));
  const int parent = branch.parent == kWorld ? -1 : rows_[static_cast<std::size_t>(branch.parent)].link;
  bullet::add_links(tree, joint, ends_at_start(scene, branch),
                    {.first = first_link,
                     .parent = parent,
                     .mass = scene.bodies[static_cast<std::size_t>(branch.body)].mass,
                     .moments = to_bullet(row.frame.moments)});
}

bullet::JointEnds BulletMultibodyWorld::ends_at_start(const Scene& scene, const bullet::Branch& branch) const {
  const auto frame = [&](int body) {
    if (body == kWorld) return bullet::LinkFrame{};
    return bullet::frame_at_start(scene.bodies[static_cast<std::size_t>(body)],
                                  rows_[static_cast<std::size_t>(body)].q_WP_start);
  };
  return {.child = frame(branch.body),
          .parent = frame(branch.parent),
          .child_is_b = scene.joints[static_cast<std::size_t>(branch.joint)].b == branch.body};
}

void BulletMultibodyWorld::step(double dt) {
  if (!loads_.empty()) add_loads(dt);
  set_motors(dt);
  if (!feedback_.empty()) note_bodies();
  world_.stepSimulation(dt, 0);  // no sub-steps
  last_dt_ = dt;
  clock_.advance(dt);
  read_bodies();
}

void BulletMultibodyWorld::ask_for_reactions() {
  feedback_.resize(hanging_.size());
  for (std::size_t n = 0; n < hanging_.size(); ++n) {
    const Row& row = rows_[static_cast<std::size_t>(hanging_[n].second.body())];
    row.tree->getLink(row.link).m_jointFeedback = &feedback_[n];
  }
}

void BulletMultibodyWorld::note_bodies() {
  before_.resize(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) before_.columns().set_body(i, rows_[i].state);
}

// Force and torque on a link through its joint, in the link's own, principal frame at the step's start, about its
// centre.
std::vector<ReportedReaction> BulletMultibodyWorld::reactions() const {
  if (before_.size() == 0) return {};
  std::vector<ReportedReaction> reactions(hanging_.size());  // no joint closes a loop here
  const BodyColumns before = before_.columns();
  for (std::size_t n = 0; n < hanging_.size(); ++n) {
    const auto& [joint, hanging] = hanging_[n];
    const auto body = static_cast<std::size_t>(hanging.body());
    const Mat3 R_WP = matrix_of(before.orientation(body)) * rows_[body].frame.R_BP;
    const btSpatialForceVector& passed = feedback_[n].m_reactionForces;
    reactions[static_cast<std::size_t>(joint)] =
        hanging.reaction(before, R_WP * to_rigor(passed.getLinear()), R_WP * to_rigor(passed.getAngular()));
  }
  return reactions;
}

void BulletMultibodyWorld::add_loads(double dt) {
  const Wrenches& wrenches = loads_.over_step(*this, dt);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const Row& row = rows_[i];
    if (!row.moves) continue;
    const btVector3 force = to_bullet(wrenches[i].force), torque = to_bullet(wrenches[i].torque);  // in W
    if (row.link < 0) {
      row.tree->addBaseForce(force), row.tree->addBaseTorque(torque);
    } else {
      row.tree->addLinkForce(row.link, force), row.tree->addLinkTorque(row.link, torque);
    }
  }
}

// Goes from the base outwards: Bullet keeps rotations and offsets from parent to child, and joint rates.
void BulletMultibodyWorld::read_bodies() {
  struct Motion {
    btQuaternion from_W;
    btVector3 position, w, v;  // w and v in the link's frame
  };
  std::vector<Motion> motions;
  for (std::size_t t = 0; t < trees_.size(); ++t) {
    const btMultiBody& tree = *trees_[t];
    const btQuaternion base = tree.getWorldToBaseRot();
    motions.assign(
        1, {base, tree.getBasePos(), quatRotate(base, tree.getBaseOmega()), quatRotate(base, tree.getBaseVel())});
    for (int link = 0; link < tree.getNumLinks(); ++link) {
      const Motion& above = motions[static_cast<std::size_t>(tree.getParent(link)) + 1];
      const btQuaternion turn = tree.getParentToLocalRot(link);
      const btVector3 offset = tree.getRVector(link);
      Motion motion{turn * above.from_W, above.position, quatRotate(turn, above.w), quatRotate(turn, above.v)};
      motion.position += quatRotate(motion.from_W.inverse(), offset);
      motion.v += motion.w.cross(offset);
      const btMultibodyLink& joint = tree.getLink(link);
      for (int k = 0; k < joint.m_dofCount; ++k) {
        const btScalar rate = tree.getJointVelMultiDof(link)[k];
        motion.w += rate * joint.getAxisTop(k), motion.v += rate * joint.getAxisBottom(k);
      }
      motions.push_back(motion);
    }
    for (std::size_t n = 0; n < motions.size(); ++n) {
      if (body_of_link_[t][n] == kWorld) continue;
      Row& row = rows_[static_cast<std::size_t>(body_of_link_[t][n])];
      const Quat q_WP = to_rigor(motions[n].from_W).conjugate();
      row.state = {to_rigor(motions[n].position), q_WP * Quat(row.frame.R_BP).conjugate(),
                   q_WP * to_rigor(motions[n].v), q_WP * to_rigor(motions[n].w)};
    }
  }
}

void BulletMultibodyWorld::read(Snapshot& out) const {
  out.time = clock_.time();
  const MutableBodyColumns columns = out.own(rows_.size());
  for (std::size_t i = 0; i < rows_.size(); ++i) columns.set_body(i, rows_[i].state);
}

SettingsInForce BulletMultibodyWorld::settings_in_force() const {
  const btVector3 g = world_.getGravity();
  SettingsInForce in_force = {
      {"precision", sizeof(btScalar) == sizeof(double) ? "double" : "single"},
      {"joints", "reduced coordinates, Featherstone's articulated-body algorithm"},
      {"gravity", fmt::format("{:g}, {:g}, {:g} m/s^2", g.x(), g.y(), g.z())},
      {"sub-steps", "none: one step of dt"},
      {"springs and timed forces", "user forces, recomputed before each step"},
  };
  // Bullet has no const getter for what its solver works with.
  const btContactSolverInfo& solver = const_cast<btMultiBodyDynamicsWorld&>(world_).getSolverInfo();
  if (shapes_.are_any()) {
    in_force.emplace_back("iterations", fmt::format("{}", solver.m_numIterations));
    in_force.emplace_back(
        "contacts", fmt::format("an overlap is pushed out by {:g} of it a step, by a speed that stays", solver.m_erp2));
    in_force.emplace_back("friction directions", solver.m_solverMode & SOLVER_USE_2_FRICTION_DIRECTIONS
                                                     ? "two, fixed in the world, limited by the cone"
                                                     : "one, fixed in the world");
  }
  if (!limits_.empty()) {
    in_force.emplace_back("limits",
                          fmt::format("stop what is past them, without rebound, by at most {:g} N s or N m s; "
                                      "pushed back a step: {:g} of it",
                                      limits_.front()->getMaxAppliedImpulse(), solver.m_erp));
  }
  if (trees_.empty()) return in_force;
  const btMultiBody& tree = *trees_.front();  // all are set alike
  in_force.emplace_back("gyroscopic", tree.getUseGyroTerm() ? "explicit, with the coordinates' accelerations" : "off");
  in_force.emplace_back("integration", tree.isUsingRK4Integration() ? "Runge-Kutta" : "semi-implicit Euler");
  in_force.emplace_back("damping",
                        fmt::format("linear {:g}, angular {:g}", tree.getLinearDamping(), tree.getAngularDamping()));
  in_force.emplace_back("fastest coordinate", fmt::format("{:g} rad/s, m/s", tree.getMaxCoordinateVelocity()));
  in_force.emplace_back("sleeping", tree.getCanSleep() ? "on" : "off");
  return in_force;
}

}  // namespace rigor::inline adapters
