#include "adapters/simbody/simbody_system.h"

#include <fmt/format.h>

#include <algorithm>

#include "adapters/common/spanning_tree.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"
#include "core/scene/validate.h"

namespace rigor::inline adapters {

namespace {

SimTK::Vec3 simbody_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 ours_of(const SimTK::Vec3& v) { return {v[0], v[1], v[2]}; }
SimTK::Rotation rotation_of(const Mat3& R) {
  return SimTK::Rotation(SimTK::Mat33(R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)),
                         true);  // it is one: taken as it is
}

bool moves(const Scene& scene, int body) { return body != kWorld && !scene.bodies[body].fixed; }

// Linear springs are Simbody's own; gravity too.
bool is_linear(const Spring& spring) { return spring.quadratic_stiffness == 0; }
Scene without_linear_springs(Scene scene) {
  scene.springs.erase(std::remove_if(scene.springs.begin(), scene.springs.end(), is_linear), scene.springs.end());
  return scene;
}

SimTK::Body::Rigid rigid_of(const Body& body) {
  const std::string why = why_no_inertia(body.inertia);
  if (!why.empty()) throw InputError(fmt::format("body '{}': inertia: {}", body.name, why));
  const Mat3& I = body.inertia;
  return SimTK::Body::Rigid(SimTK::MassProperties(
      body.mass, SimTK::Vec3(0), SimTK::Inertia(I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2), I(1, 2))));
}

}  // namespace

// The loads of Rigor's law on each body, computed at each stage of a step.
class StageLoads : public SimTK::Force::Custom::Implementation {
 public:
  explicit StageLoads(const SimbodySystem& owner) : owner_(owner), bodies_(owner.scene_.bodies.size()) {}

  void calcForce(const SimTK::State& state, SimTK::Vector_<SimTK::SpatialVec>& on_bodies, SimTK::Vector_<SimTK::Vec3>&,
                 SimTK::Vector&) const override {
    owner_.read(state, bodies_.columns());
    for (std::size_t i = 0; i < bodies_.size(); ++i)  // a stage's quaternion is not of length 1; Simbody's pose is
      bodies_.columns().set_orientation(i, bodies_.columns().orientation(i).normalized());
    owner_.loads_.evaluate(bodies_.columns(), owner_.from_, owner_.to_ - owner_.from_, wrenches_);
    for (std::size_t i = 0; i < wrenches_.size(); ++i) {
      if (!owner_.scene_.bodies[i].fixed)
        on_bodies[owner_.bodies_[i]] +=
            SimTK::SpatialVec(simbody_of(wrenches_[i].torque), simbody_of(wrenches_[i].force));
    }
  }
  SimTK::Real calcPotentialEnergy(const SimTK::State&) const override { return 0; }  // nobody asks

 private:
  const SimbodySystem& owner_;
  mutable BodyTable bodies_;
  mutable Wrenches wrenches_;
};

SimbodySystem::SimbodySystem(const Scene& scene)
    : scene_(scene),
      loads_(without_linear_springs(scene)),
      matter_(system_),
      forces_(system_),
      gravity_(forces_, matter_, simbody_of(scene.gravity)),
      bodies_(scene.bodies.size(), SimTK::MobilizedBodyIndex(SimTK::GroundIndex)),
      is_free_(scene.bodies.size()) {
  system_.setUseUniformBackground(true);  // or it counts on a visualizer's ground
  const std::vector<Mobilizer> mobilizers = mobilizers_of(scene_);
  for (const Mobilizer& joint : mobilizers) add(joint);
  add_springs();
  if (!loads_.empty()) SimTK::Force::Custom(forces_, new StageLoads(*this));  // it takes it over
  for (const int k : spanning_tree(scene_).loops) add_loop(k);
  start_ = system_.realizeTopology();
  system_.realizeModel(start_);
  for (const Mobilizer& joint : mobilizers) set_start(joint);
}

SimTK::MobilizedBody SimbodySystem::mobilized(int body) {
  return matter_.updMobilizedBody(body == kWorld ? SimTK::MobilizedBodyIndex(SimTK::GroundIndex) : bodies_[body]);
}

// A frame in that of a body, or of Ground where the body cannot move.
SimTK::Transform SimbodySystem::frame_in(int body, const Mat3& axes_W, const Vec3& origin_W) const {
  const BodyPose pose = moves(scene_, body) ? scene_.pose(body) : BodyPose{};
  const Mat3 to_body = matrix_of(pose.orientation).transpose();
  return SimTK::Transform(rotation_of(to_body * axes_W), simbody_of(to_body * (origin_W - pose.position)));
}

void SimbodySystem::add(const Mobilizer& joint) {
  using SimTK::MobilizedBody;
  const SimTK::Body::Rigid rigid = rigid_of(scene_.bodies[joint.body]);
  MobilizedBody above = mobilized(joint.parent);
  const SimTK::Transform in_parent = frame_in(joint.parent, joint.axes, joint.origin),
                         in_body = frame_in(joint.body, joint.axes, joint.origin);
  const auto made = [&]() -> MobilizedBody {
    switch (joint.kind) {
      case MobilizerKind::free:
        return MobilizedBody::Free(above, SimTK::Transform(), rigid, SimTK::Transform());
      case MobilizerKind::ball:
        return MobilizedBody::Ball(above, in_parent, rigid, in_body);
      case MobilizerKind::cylinder:
        return MobilizedBody::Cylinder(above, in_parent, rigid, in_body);
      case MobilizerKind::pin:
        return MobilizedBody::Pin(above, in_parent, rigid, in_body);
      case MobilizerKind::slider:
        return MobilizedBody::Slider(above, in_parent, rigid, in_body);
      case MobilizerKind::universal:
        return MobilizedBody::Universal(above, in_parent, rigid, in_body);
      case MobilizerKind::weld:
        break;
    }
    return MobilizedBody::Weld(above, in_parent, rigid, in_body);
  };
  bodies_[joint.body] = made().getMobilizedBodyIndex();
  is_free_[joint.body] = joint.kind == MobilizerKind::free;
}

// Its springs divide by their length.
void SimbodySystem::refuse_no_length(const Spring& spring) const {
  const BodyPose a = scene_.pose(spring.a), b = scene_.pose(spring.b);
  if ((a.position + a.orientation * spring.point_a - b.position - b.orientation * spring.point_b).norm() > 0) return;
  throw EngineFailure(FailureKind::unsupported,
                      fmt::format("the two ends of a spring between '{}' and '{}' are at one point, and Simbody's "
                                  "springs have no direction there",
                                  scene_.body_name(spring.a), scene_.body_name(spring.b)));
}

void SimbodySystem::add_springs() {
  for (const Spring& spring : scene_.springs) {
    if (!is_linear(spring)) continue;
    const auto station = [&](int body, const Vec3& point) {
      if (body == kWorld || moves(scene_, body)) return simbody_of(point);
      const BodyPose pose = scene_.pose(body);
      return simbody_of(pose.position + pose.orientation * point);
    };
    const SimTK::Vec3 a = station(spring.a, spring.point_a), b = station(spring.b, spring.point_b);
    refuse_no_length(spring);
    SimTK::Force::TwoPointLinearSpring(forces_, mobilized(spring.a), a, mobilized(spring.b), b, spring.stiffness,
                                       spring.rest_length);
    if (spring.damping > 0)
      SimTK::Force::TwoPointLinearDamper(forces_, mobilized(spring.a), a, mobilized(spring.b), b, spring.damping);
  }
}

void SimbodySystem::add_loop(int k) {
  const Joint& joint = scene_.joints[static_cast<std::size_t>(k)];
  const SimTK::ConstraintIndex first(matter_.getNumConstraints());
  add_constraints(joint);
  loops_.push_back(
      {k, moves(scene_, joint.b) ? joint.b : joint.a, first, SimTK::ConstraintIndex(matter_.getNumConstraints())});
}

// Constraints, which are met in the accelerations of each stage, and projected to after each step.
void SimbodySystem::add_constraints(const Joint& joint) {
  using namespace SimTK;
  MobilizedBody a = mobilized(joint.a), b = mobilized(joint.b);
  const Mat3 straight = Mat3::Identity();
  const auto point_in = [&](int body, const Vec3& point) { return frame_in(body, straight, point).p(); };
  const auto direction_in = [&](int body, const Vec3& direction) {
    return UnitVec3(frame_in(body, straight, Vec3::Zero()).R() * simbody_of(direction));
  };
  const auto at_right_angles = [&](const Vec3& of_a, const Vec3& of_b) {
    Constraint::ConstantAngle(a, direction_in(joint.a, of_a), b, direction_in(joint.b, of_b), Pi / 2);
  };
  const auto same_orientation = [&] {
    Constraint::ConstantOrientation(a, frame_in(joint.a, straight, Vec3::Zero()).R(), b,
                                    frame_in(joint.b, straight, Vec3::Zero()).R());
  };
  const auto share_point = [&](const Vec3& point) {
    Constraint::Ball(a, point_in(joint.a, point), b, point_in(joint.b, point));
  };
  const auto share_axis = [&](const Vec3& axis) {
    const Mat3 axes = axes_with(2, axis);
    at_right_angles(axes.col(0), axis), at_right_angles(axes.col(1), axis);
  };
  const auto share_line = [&](const Vec3& axis, const Vec3& point) {
    Constraint::PointOnLine(a, direction_in(joint.a, axis), point_in(joint.a, point), b, point_in(joint.b, point));
  };
  const BodyPose pose_a = scene_.pose(joint.a), pose_b = scene_.pose(joint.b);
  std::visit(ForJoints{[&](const BallJoint& ball) { share_point(ball.anchor); },
                       [&](const CylindricalJoint& cylinder) {
                         share_line(cylinder.axis, cylinder.anchor), share_axis(cylinder.axis);
                       },
                       [&](const DistanceJoint& distance) {
                         const Vec3 end_a = pose_a.position + pose_a.orientation * distance.point_a,
                                    end_b = pose_b.position + pose_b.orientation * distance.point_b;
                         Constraint::Rod(a, point_in(joint.a, end_a), b, point_in(joint.b, end_b),
                                         (end_b - end_a).norm());
                       },
                       [&](const FixedJoint&) {
                         Constraint::Weld(a, frame_in(joint.a, straight, pose_b.position), b,
                                          frame_in(joint.b, straight, pose_b.position));
                       },
                       [&](const HingeJoint& hinge) { share_point(hinge.anchor), share_axis(hinge.axis); },
                       [&](const SliderJoint& slider) { same_orientation(), share_line(slider.axis, pose_b.position); },
                       [&](const UniversalJoint& universal) {
                         share_point(universal.anchor), at_right_angles(universal.axis, universal.axis2);
                       },
                       LackingJoints<void, CompoundAxis, CompoundJoint, PlanarJoint, ScrewJoint>()},
             joint.type);
}

// The velocity of M in F, in F's axes; a mobilizer with fewer than six speeds takes its part of them.
void SimbodySystem::set_start(const Mobilizer& joint) {
  const Body& body = scene_.bodies[joint.body];
  const SimTK::MobilizedBody& mobilized_body = matter_.getMobilizedBody(bodies_[joint.body]);
  if (joint.kind == MobilizerKind::free) {
    const Quat& q = body.orientation;
    const double coordinates[] = {q.w(), q.x(), q.y(), q.z(), body.position.x(), body.position.y(), body.position.z()};
    for (int i = 0; i < 7; ++i) mobilized_body.setOneQ(start_, i, coordinates[i]);
    mobilized_body.setUToFitVelocity(start_,
                                     SimTK::SpatialVec(simbody_of(body.angular_velocity), simbody_of(body.velocity)));
    return;
  }
  const bool hangs_on_body = moves(scene_, joint.parent);
  const Vec3 centre = hangs_on_body ? scene_.bodies[joint.parent].position : Vec3::Zero(),
             v_parent = hangs_on_body ? scene_.bodies[joint.parent].velocity : Vec3::Zero(),
             w_parent = hangs_on_body ? scene_.bodies[joint.parent].angular_velocity : Vec3::Zero();
  const Vec3 v = body.velocity + body.angular_velocity.cross(joint.origin - body.position) - v_parent -
                 w_parent.cross(joint.origin - centre),
             w = body.angular_velocity - w_parent;
  mobilized_body.setUToFitVelocity(
      start_, SimTK::SpatialVec(simbody_of(joint.axes.transpose() * w), simbody_of(joint.axes.transpose() * v)));
}

// A number that changes where the motor's effort jumps.
double SimbodySystem::share_of_motor(const Motor& motor, double t, double dt) {
  if (motor.efforts) return motor.mean_effort(t, dt);
  const double share = share_of_step(motor.from, motor.until, t, dt);
  return motor.servo && motor.servo->period > 0 && share > 0 ? 1 + motor.sample_at(t) : share;
}

bool SimbodySystem::set_interval(double from, double to) {
  from_ = from, to_ = to;
  std::vector<double> shares;
  for (const TimedForce& force : scene_.forces) shares.push_back(share_of_step(force, from, to - from));
  for (const Motor& motor : scene_.motors) shares.push_back(share_of_motor(motor, from, to - from));
  const bool differ = shares != shares_;
  shares_ = std::move(shares);
  return differ;
}

void SimbodySystem::read(const SimTK::State& state, MutableBodyColumns out) const {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& fixed = scene_.bodies[i];
    if (fixed.fixed) {
      out.set_body(i, {fixed.position, fixed.orientation, Vec3::Zero(), Vec3::Zero()});
      continue;
    }
    const SimTK::MobilizedBody& body = matter_.getMobilizedBody(bodies_[i]);
    const SimTK::Transform& pose = body.getBodyTransform(state);
    const SimTK::SpatialVec& velocity = body.getBodyVelocity(state);
    // For a free body, the coordinates themselves. Its pose is computed from the normalised quaternion, which would
    // hide a lost norm.
    const SimTK::Vec4 q = is_free_[i] ? SimTK::Vec4(body.getOneQ(state, 0), body.getOneQ(state, 1),
                                                    body.getOneQ(state, 2), body.getOneQ(state, 3))
                                      : SimTK::Vec4(pose.R().convertRotationToQuaternion());
    out.set_body(i, {ours_of(pose.p()), Quat(q[0], q[1], q[2], q[3]), ours_of(velocity[1]), ours_of(velocity[0])});
  }
}

}  // namespace rigor::inline adapters
