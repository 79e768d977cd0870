#include "adapters/dart/dart_world.h"

#include <fmt/format.h>

#include <dart/collision/dart/DARTCollisionDetector.hpp>
#include <dart/constraint/BallJointConstraint.hpp>
#include <dart/constraint/BoxedLcpConstraintSolver.hpp>
#include <dart/constraint/DantzigBoxedLcpSolver.hpp>
#include <dart/constraint/PgsBoxedLcpSolver.hpp>
#include <dart/constraint/WeldJointConstraint.hpp>
#include <dart/simulation/World.hpp>
#include <limits>
#include <numbers>

#include "adapters/common/external_loads.h"
#include "adapters/common/hanging_joint.h"
#include "adapters/common/option_values.h"
#include "adapters/dart/dart_constants.h"
#include "adapters/dart/dart_contacts.h"
#include "adapters/dart/dart_matched.h"
#include "adapters/dart/dart_options.h"
#include "core/engine/clock.h"
#include "core/engine/engine_failure.h"
#include "core/engine/saved_bytes.h"
#include "core/scene/contact_laws.h"
#include "core/scene/turn_window.h"

namespace rigor::inline adapters {
namespace {

namespace con = ::dart::constraint;

// m/s, rad/s. No motion has such speeds; soon after, a number is not finite, and DART would abort the process.
constexpr double kDartRunaway = 1e50;

bool runs_away(const Vec3& v) { return !(v.squaredNorm() < kDartRunaway * kDartRunaway); }

// The loads that DART does not have: springs and forces, motors of effort, the drives of joints that close loops, and
// springs of joints whose stiffness grows.
Scene external_part(const Scene& scene, const SpanningTree& tree) {
  Scene left;
  left.bodies = scene.bodies, left.springs = scene.springs, left.forces = scene.forces, left.joints = scene.joints;
  for (const SpanningTree::Link& link : tree.links) {
    if (link.joint < 0) continue;
    Joint& joint = left.joints[link.joint];
    joint.damping = 0;
    if (joint.quadratic_stiffness == 0) joint.stiffness = 0;
  }
  for (const Motor& motor : scene.motors) {
    if (!motor.speed) left.motors.push_back(motor);
  }
  return left;
}

bool closes_loops(const Joint& joint) {
  return std::visit(ForJoints{[](const BallJoint&) { return true; }, [](const FixedJoint&) { return true; },
                              [](const HingeJoint&) { return true; }, [](const auto&) { return false; }},
                    joint.type);
}

void refuse_what_features_do_not_say(const Scene& scene, const SpanningTree& tree) {
  const auto refuse = [&](int joint, const char* why) {
    throw EngineFailure(FailureKind::unsupported,
                        fmt::format("{} {}", scene.joint_name(static_cast<std::size_t>(joint)), why));
  };
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    if (scene.joints[k].has_limits() && scene.joints[k].restitution > 0)
      refuse(static_cast<int>(k), "bounces at its limits, and DART's limits have no restitution");
    const bool is_beyond = scene.joints[k].lower < -std::numbers::pi || scene.joints[k].upper > std::numbers::pi;
    if (scene.joints[k].has_limits() && is_beyond && scene.joints[k].stiffness > 0 && turns(scene.joints[k]) &&
        !middle_of_turn(scene.joints[k]))
      refuse(static_cast<int>(k), "has a spring and a limit beyond half a turn, and DART counts one angle for both");
  }
  for (const int k : tree.loops) {
    if (!closes_loops(scene.joints[k]))
      refuse(k, "closes a loop of joints, which DART closes by balls and fixed joints, and hinges by two balls, alone");
    if (scene.joints[k].has_limits()) refuse(k, "closes a loop of joints, where DART has no limits");
    for (const Motor& motor : scene.motors)
      if (motor.joint == k && motor.speed)
        refuse(k, "closes a loop of joints, where DART has no motor of a given speed");
  }
}

class DartWorld : public World, public ReportsReactions, public ReportsContacts, public ArchivesState {
 public:
  DartWorld(const Scene& scene, const Settings& settings);

  void step(double dt) override;
  void read(Snapshot& out) const override;
  SettingsInForce settings_in_force() const override;
  std::string solver_warning() const override { return solver_warning_; }
  // DART works out what passes to a body before its constraints get their impulses. Loops are constraints.
  Capabilities capabilities() override { return {.reactions = this, .contacts = this, .state = this}; }
  void ask_for_reactions() override { is_asked_ = !has_loops_; }
  std::vector<ReportedReaction> reactions() const override;
  void ask_for_contacts() override {}  // DART always keeps them
  std::vector<ReportedContact> contacts() const override;

 private:
  void archive_state(StateArchive& archive) override;
  void set_solver(const Settings& settings);
  void set_constants(const Settings& settings);
  void close_loops(const Scene& scene, const SpanningTree& tree);
  void add_loads(double dt);
  void drive(double time);
  void unwind();
  void look_back();
  const con::BoxedLcpConstraintSolver& solver() const {
    return static_cast<const con::BoxedLcpConstraintSolver&>(*world_->getConstraintSolver());
  }

  std::vector<bool> fixed_;
  std::vector<BodyState> standing_;
  ExternalLoads loads_;
  std::vector<Motor> speed_motors_;
  std::vector<std::size_t> wound_;  // joints whose springs count from -pi to pi
  bool can_touch_, matched_, has_loops_;
  DartBodies made_;
  std::shared_ptr<::dart::collision::CollisionFilter> filter_;
  DartPlaneEdges edges_;
  ::dart::simulation::WorldPtr world_;
  dart_library::Constants constants_;
  bool lost_ = false;                                  // blown up: from then on its state is "not a number"
  std::vector<std::pair<int, HangingJoint>> hanging_;  // by joint
  bool is_asked_ = false, has_stepped_ = false;
  Snapshot before_;  // the last step, once asked
  Clock clock_;
  std::string solver_warning_;
};

DartWorld::DartWorld(const Scene& scene, const Settings& settings)
    : ArchivesState("dart", DART_VERSION, scene, settings),
      loads_(external_part(scene, spanning_tree(scene))),
      can_touch_(anything_can_touch(scene)),
      matched_(settings.track == Track::matched),
      edges_(scene),
      constants_(dart_library::constants_in_force()) {
  const dart_library::Messages silent;
  const SpanningTree tree = spanning_tree(scene);
  refuse_what_features_do_not_say(scene, tree);
  made_ = dart_bodies(scene, tree);
  if (can_touch_) filter_ = add_dart_shapes(scene, made_);
  for (const Body& body : scene.bodies) {
    fixed_.push_back(body.fixed);
    standing_.push_back({body.position, body.orientation, Vec3::Zero(), Vec3::Zero()});
    lost_ = lost_ || runs_away(body.velocity) || runs_away(body.angular_velocity);
  }
  for (const Motor& motor : scene.motors)
    if (motor.speed) speed_motors_.push_back(motor);
  for (std::size_t k = 0; k < scene.joints.size(); ++k) {
    const Joint& joint = scene.joints[k];
    const bool winds = made_.coordinates[k].joint && turns(joint);
    if (winds && joint.stiffness > 0 && joint.quadratic_stiffness == 0 && !joint.has_limits()) wound_.push_back(k);
  }
  for (int i = 0; i < static_cast<int>(scene.bodies.size()); ++i) {
    const int joint = tree.links[i].joint;
    if (!fixed_[i] && joint >= 0) hanging_.emplace_back(joint, HangingJoint(scene, joint, i));
  }
  has_loops_ = !tree.loops.empty();
  world_ = ::dart::simulation::World::create();
  world_->setGravity(scene.gravity);
  for (const auto& skeleton : made_.skeletons) world_->addSkeleton(skeleton);
  set_solver(settings), set_constants(settings);
  close_loops(scene, tree);
}

void DartWorld::set_solver(const Settings& settings) {
  auto solver = std::make_unique<con::BoxedLcpConstraintSolver>();
  if (settings.method == "pgs") {
    solver->setBoxedLcpSolver(std::make_shared<con::PgsBoxedLcpSolver>());
    solver->setSecondaryBoxedLcpSolver(nullptr);
  }
  if (matched_) {
    solver->setCollisionDetector(::dart::collision::DARTCollisionDetector::create());
    solver->getCollisionOption().maxNumContacts = kDartMostContacts;
  }
  world_->setConstraintSolver(std::move(solver));
  if (filter_) world_->getConstraintSolver()->getCollisionOption().collisionFilter = filter_;
}

void DartWorld::set_constants(const Settings& settings) {
  if (matched_) constants_ = {kDartContactErp, kDartContactSpeed, kDartCfm, kDartLoopErp, kDartCfm};
  if (const auto erp = number_to_set(settings, kDartErp)) constants_.contact_erp = constants_.loop_erp = *erp;
  if (const auto cfm = number_to_set(settings, kDartSoftness)) constants_.contact_cfm = constants_.loop_cfm = *cfm;
}

// A hinge is two points on its axis, a metre apart: of their six rows one repeats another, which the cfm bears.
void DartWorld::close_loops(const Scene& scene, const SpanningTree& tree) {
  for (const int k : tree.loops) {
    const Joint& joint = scene.joints[k];
    const auto moving = [&](int body) { return body == kWorld || fixed_[body] ? nullptr : made_.bodies[body]; };
    ::dart::dynamics::BodyNode *first = moving(joint.a), *second = moving(joint.b);
    if (!first) std::swap(first, second);
    if (!first) continue;  // nothing of it moves
    const auto meet = [&](const Vec3& point) {
      world_->getConstraintSolver()->addConstraint(
          second ? std::make_shared<con::BallJointConstraint>(first, second, point)
                 : std::make_shared<con::BallJointConstraint>(first, point));
    };
    std::visit(ForJoints{[&](const BallJoint& ball) { meet(ball.anchor); },
                         [&](const HingeJoint& hinge) {
                           meet(hinge.anchor - 0.5 * hinge.axis), meet(hinge.anchor + 0.5 * hinge.axis);
                         },
                         [&](const FixedJoint&) {
                           world_->getConstraintSolver()->addConstraint(
                               second ? std::make_shared<con::WeldJointConstraint>(first, second)
                                      : std::make_shared<con::WeldJointConstraint>(first));
                         },
                         [](const CylindricalJoint&) {}, [](const DistanceJoint&) {},  // not among the features
                         [](const SliderJoint&) {}, [](const UniversalJoint&) {},      // refused by closes_loops()
                         LackingJoints<void, CompoundAxis, CompoundJoint, PlanarJoint, ScrewJoint>()},
               joint.type);
  }
}

void DartWorld::step(double dt) {
  solver_warning_.clear();
  if (!lost_) {
    const dart_library::Messages messages;
    const dart_library::ForOneStep in_force(constants_);
    if (!loads_.empty()) add_loads(dt);
    drive(clock_.time() + 0.5 * dt);
    unwind();
    world_->setTimeStep(dt);
    if (is_asked_ && !lost_) read(before_);
    if (!lost_) world_->step();
    has_stepped_ = is_asked_;
    solver_warning_ = messages.first();
  }
  clock_.advance(dt);
  look_back();
}

// In W; DART clears both after the step.
void DartWorld::add_loads(double dt) {
  const Wrenches& wrenches = loads_.over_step(*this, dt);
  for (std::size_t i = 0; i < made_.bodies.size(); ++i) {
    if (fixed_[i]) continue;
    lost_ = lost_ || runs_away(wrenches[i].force) || runs_away(wrenches[i].torque);
    made_.bodies[i]->addExtForce(wrenches[i].force);
    made_.bodies[i]->addExtTorque(wrenches[i].torque, false);
  }
}

// Torque and force on a body through its joint, in the body's frame at the step's start, about its centre.
std::vector<ReportedReaction> DartWorld::reactions() const {
  std::vector<ReportedReaction> reactions(has_stepped_ ? hanging_.size() : 0);
  if (reactions.empty()) return {};
  for (const auto& [joint, hanging] : hanging_) {
    const auto body = static_cast<std::size_t>(hanging.body());
    const Eigen::Matrix<double, 6, 1>& passed = made_.bodies[body]->getBodyForce();
    const Quat q = before_.bodies().orientation(body);
    reactions[static_cast<std::size_t>(joint)] =
        hanging.reaction(before_.bodies(), q * passed.tail<3>(), q * passed.head<3>());
  }
  return reactions;
}

// Those of the step's start. DART's normal points from its second body to its first, and its force is that on the
// first, both in W.
std::vector<ReportedContact> DartWorld::contacts() const {
  std::vector<ReportedContact> contacts;
  if (clock_.time() == 0 || lost_ || !can_touch_) return contacts;
  const auto body_of = [&](const ::dart::collision::CollisionObject* object) {
    const auto node = object->getShapeFrame()->asShapeNode()->getBodyNodePtr();
    return static_cast<int>(std::find(made_.bodies.begin(), made_.bodies.end(), node) - made_.bodies.begin());
  };
  for (const ::dart::collision::Contact& at : world_->getLastCollisionResult().getContacts())
    contacts.push_back({body_of(at.collisionObject2), body_of(at.collisionObject1), at.point, at.normal,
                        -at.penetrationDepth, at.force});
  return contacts;
}

// Coordinates and speeds, as DART's own Skeleton::Configuration has them. DART keeps the multipliers of limits, motors
// and loops to itself; the method pgs begins its sweeps with them.
void DartWorld::archive_state(StateArchive& archive) {
  archive(clock_, lost_, solver_warning_, loads_);
  for (const auto& skeleton : made_.skeletons) {
    Eigen::VectorXd positions = skeleton->getPositions(), velocities = skeleton->getVelocities();
    archive(positions, velocities);
    if (!archive.restores()) continue;
    skeleton->setPositions(positions), skeleton->setVelocities(velocities);
  }
}

// A joint keeps a given speed, with a bounded effort, while a motor is on; DART forgets the command after the step.
void DartWorld::drive(double time) {
  for (const Motor& motor : speed_motors_)
    made_.coordinates[motor.joint].joint->setActuatorType(::dart::dynamics::Joint::FORCE);
  for (const Motor& motor : speed_motors_) {
    if (time < motor.from || time >= motor.until) continue;
    const auto& [joint, sign] = made_.coordinates[motor.joint];
    joint->setActuatorType(::dart::dynamics::Joint::SERVO);
    joint->setForceLowerLimit(0, -motor.most), joint->setForceUpperLimit(0, motor.most);
    joint->setCommand(0, sign * *motor.speed);
  }
}

// DART's springs count whole turns, the scene's from -pi to pi.
void DartWorld::unwind() {
  for (const std::size_t k : wound_) {
    ::dart::dynamics::Joint* joint = made_.coordinates[k].joint;
    const double angle = joint->getPosition(0);
    if (std::abs(angle) > std::numbers::pi) joint->setPosition(0, std::remainder(angle, 2 * std::numbers::pi));
  }
}

void DartWorld::look_back() {
  for (std::size_t i = 0; i < made_.bodies.size() && !lost_; ++i) {
    if (fixed_[i]) continue;
    lost_ = runs_away(made_.bodies[i]->getLinearVelocity()) || runs_away(made_.bodies[i]->getAngularVelocity());
  }
  if (lost_) {
    solver_warning_ = fmt::format("a speed or force passed {:g}: DART was stopped before it would abort", kDartRunaway);
    return;
  }
  if (!can_touch_) return;
  const ::dart::collision::CollisionResult& contacts = world_->getLastCollisionResult();
  const std::size_t most = world_->getConstraintSolver()->getCollisionOption().maxNumContacts;
  if (contacts.getNumContacts() >= most)
    solver_warning_ = fmt::format("DART takes {} contacts a step, and left the others out", most);
  Snapshot now;
  read(now);
  edges_.check(now.bodies());
}

void DartWorld::read(Snapshot& out) const {
  out.time = clock_.time();
  const MutableBodyColumns columns = out.own(made_.bodies.size());
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const BodyState nowhere = {Vec3::Constant(kNaN), Quat(kNaN, kNaN, kNaN, kNaN), Vec3::Constant(kNaN),
                             Vec3::Constant(kNaN)};
  for (std::size_t i = 0; i < made_.bodies.size(); ++i) {
    if (fixed_[i] || lost_) {
      columns.set_body(i, fixed_[i] ? standing_[i] : nowhere);
      continue;
    }
    const ::dart::dynamics::BodyNode& body = *made_.bodies[i];
    const Eigen::Isometry3d& pose = body.getWorldTransform();
    columns.set_body(i, {pose.translation(), Quat(pose.linear()), body.getLinearVelocity(), body.getAngularVelocity()});
  }
}

SettingsInForce DartWorld::settings_in_force() const {
  const Vec3& g = world_->getGravity();
  const bool by_pgs = solver().getBoxedLcpSolver()->getType() == con::PgsBoxedLcpSolver::getStaticType();
  SettingsInForce in_force = {
      {"precision", "double"},
      {"solver", solver().getSecondaryBoxedLcpSolver()
                     ? solver().getBoxedLcpSolver()->getType() + ", and where it fails " +
                           solver().getSecondaryBoxedLcpSolver()->getType()
                     : solver().getBoxedLcpSolver()->getType()},
      {"gravity", fmt::format("{:g}, {:g}, {:g} m/s^2", g.x(), g.y(), g.z())},
      {"gyroscopic", "explicit, body frame"},
      {"joints", "coordinates of trees of bodies; their springs and dampers implicit, taken at the step's end"},
      {"springs and timed forces", "user forces, recomputed before each step"},
  };
  if (by_pgs) {
    const auto& pgs = static_cast<const con::PgsBoxedLcpSolver&>(*solver().getBoxedLcpSolver());
    in_force.emplace_back("iterations", fmt::format("{}", pgs.getOption().mMaxIteration));
  }
  if (solver().getNumConstraints() > 0) {
    in_force.emplace_back("loops",
                          fmt::format("erp {:g} of a gap a step, cfm {:g}", constants_.loop_erp, constants_.loop_cfm));
  }
  if (!can_touch_) return in_force;
  in_force.emplace_back("collision detector", solver().getCollisionDetector()->getType());
  in_force.emplace_back("contacts", fmt::format("erp {:g} of an overlap a step, at most {:g} m/s; cfm {:g}; {} at most",
                                                constants_.contact_erp, constants_.contact_speed,
                                                constants_.contact_cfm, solver().getCollisionOption().maxNumContacts));
  in_force.emplace_back("friction",
                        "pyramid, its directions chosen by the engine. Along its diagonal it brakes with "
                        "sqrt(2) of the force, and a slide ends after 0.71 of its way");
  in_force.emplace_back("bounce threshold", "0.1 m/s, of the speed that would be given back");
  return in_force;
}

}  // namespace

std::unique_ptr<World> make_dart_world(const Scene& scene, const Settings& settings) {
  return std::make_unique<DartWorld>(scene, settings);
}

}  // namespace rigor::inline adapters
