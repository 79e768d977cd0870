#include "cases/truth/solved/events/equivalent_scene.h"

#include <algorithm>
#include <cassert>

#include "core/scene/turned.h"

namespace rigor::inline truth {
namespace {

Vec3 mirrored(const Vec3& v) { return {-v.x(), v.y(), v.z()}; }
// Of an angular velocity, a torque or an axis of rotation.
Vec3 mirrored_axial(const Vec3& v) { return {v.x(), -v.y(), -v.z()}; }
// The frame of a body is mirrored, too, so that it stays right-handed.
Quat mirrored(const Quat& q) { return {q.w(), q.x(), -q.y(), -q.z()}; }

struct MirrorJoint {
  void operator()(BallJoint& joint) const { joint.anchor = mirrored(joint.anchor); }
  // An angle keeps its sign.
  void operator()(HingeJoint& joint) const {
    joint.anchor = mirrored(joint.anchor), joint.axis = mirrored_axial(joint.axis);
  }
  void operator()(SliderJoint& joint) const { joint.axis = mirrored(joint.axis); }
  void operator()(CylindricalJoint& joint) const {  // it has no limits, so that the sign of its axis is free
    joint.anchor = mirrored(joint.anchor), joint.axis = mirrored(joint.axis);
  }
  void operator()(CompoundJoint& joint) const {
    for (SeriesAxis& axis : joint.axes) mirror(axis);
  }
  void operator()(CompoundAxis& joint) const {
    for (SeriesAxis& axis : joint.axes) mirror(axis);
  }
  void operator()(PlanarJoint& joint) const {
    joint.anchor = mirrored(joint.anchor), joint.normal = mirrored(joint.normal);
  }
  void operator()(ScrewJoint& joint) const {
    joint.anchor = mirrored(joint.anchor), joint.axis = mirrored(joint.axis), joint.pitch = -joint.pitch;
  }
  static void mirror(SeriesAxis& axis) {
    axis.anchor = mirrored(axis.anchor), axis.axis = axis.turns ? mirrored_axial(axis.axis) : mirrored(axis.axis);
  }
  void operator()(FixedJoint&) const {}
  void operator()(DistanceJoint& joint) const {
    joint.point_a = mirrored(joint.point_a), joint.point_b = mirrored(joint.point_b);
  }
  void operator()(UniversalJoint& joint) const {
    joint.anchor = mirrored(joint.anchor), joint.axis = mirrored(joint.axis), joint.axis2 = mirrored(joint.axis2);
  }
};

// The other shapes are their own mirror images. Surfaces of triangles are not mirrored.
Shape mirrored_shape(Shape shape) {
  assert(!surface_in(shape) && "callers do not mirror these scenes");
  if (auto* plane = std::get_if<Plane>(&shape)) plane->normal = mirrored(plane->normal);
  if (auto* convex = std::get_if<Convex>(&shape)) convex->hull = mirrored_hull(*convex->hull);
  if (auto* compound = std::get_if<Compound>(&shape)) {
    for (PlacedShape& part : compound->parts) {
      part.shape = mirrored_shape(part.shape);
      part.pose = {mirrored(part.pose.position), mirrored(part.pose.orientation)};
    }
  }
  return shape;
}

void mirror(Scene& scene) {
  const Mat3 S = Vec3(-1, 1, 1).asDiagonal();
  scene.gravity = mirrored(scene.gravity);
  for (Body& body : scene.bodies) {
    body.inertia = (S * body.inertia * S).eval();
    body.position = mirrored(body.position), body.orientation = mirrored(body.orientation);
    body.velocity = mirrored(body.velocity), body.angular_velocity = mirrored_axial(body.angular_velocity);
    if (body.shape) body.shape = mirrored_shape(*body.shape);
  }
  for (Spring& spring : scene.springs)
    spring.point_a = mirrored(spring.point_a), spring.point_b = mirrored(spring.point_b);
  for (Joint& joint : scene.joints) std::visit(MirrorJoint{}, joint.type);
  for (TimedForce& force : scene.forces) {
    force.force = mirrored(force.force), force.torque = mirrored_axial(force.torque);
    force.point = mirrored(force.point);
  }
}

void reverse(Scene& scene) {
  const int last = static_cast<int>(scene.bodies.size()) - 1;
  const auto move = [last](int& body) {
    if (body != kWorld) body = last - body;
  };
  std::reverse(scene.bodies.begin(), scene.bodies.end());
  for (Spring& spring : scene.springs) move(spring.a), move(spring.b);
  for (Joint& joint : scene.joints) move(joint.a), move(joint.b);
  for (ContactPair& pair : scene.contact_pairs) move(pair.a), move(pair.b);
  for (TimedForce& force : scene.forces) move(force.body);
}

struct ScaleJoint {
  double L;
  void operator()(BallJoint& joint) const { joint.anchor *= L; }
  void operator()(HingeJoint& joint) const { joint.anchor *= L; }
  void operator()(SliderJoint&) const {}
  void operator()(CylindricalJoint& joint) const { joint.anchor *= L; }
  void operator()(FixedJoint&) const {}
  void operator()(DistanceJoint& joint) const { joint.point_a *= L, joint.point_b *= L; }
  void operator()(UniversalJoint& joint) const { joint.anchor *= L; }
  void operator()(PlanarJoint& joint) const { joint.anchor *= L; }
  void operator()(ScrewJoint& joint) const { joint.anchor *= L, joint.pitch *= L; }
  void operator()(CompoundJoint& joint) const {
    for (SeriesAxis& axis : joint.axes) axis.anchor *= L;
  }
  void operator()(CompoundAxis& joint) const {
    for (SeriesAxis& axis : joint.axes) axis.anchor *= L;
  }
};

bool slides(const Joint& joint) { return free_axis(joint) && !rigor::turns(joint); }

// The unit of a joint's coordinate: 1 of an angle.
double unit_of(const Joint& joint, double L) { return slides(joint) ? L : 1; }

struct Units {
  double L, T, M;
  double force() const { return M * L / (T * T); }
  double effort(const Joint& joint) const { return slides(joint) ? force() : force() * L; }
};

void scale(TimeTable& table, double value, double T) {
  for (double& time : table.times) time *= T;
  for (double& each : table.values) each *= value;
}

void scale_motor(Motor& motor, const Scene& scene, const Units& units) {
  const Joint& joint = scene.joints[motor.joint];
  const double T = units.T, x = unit_of(joint, units.L), effort = units.effort(joint);
  motor.effort *= effort, motor.most *= effort;
  if (motor.efforts) scale(*motor.efforts, effort, T);
  if (motor.speed) *motor.speed *= x / T;
  motor.from *= T, motor.until *= T;
  if (motor.servo) {
    scale(motor.servo->target, x, T);
    motor.servo->kp *= effort / x, motor.servo->kd *= effort / x * T;
    motor.servo->target_speed *= x / T, motor.servo->most *= effort, motor.servo->period *= T;
  }
  for (JointTerm& term : motor.plus) term.ratio *= x / unit_of(scene.joints[term.joint], units.L);
}

void scale_joints(Scene& scene, const Units& units) {
  for (Joint& joint : scene.joints) {
    std::visit(ScaleJoint{units.L}, joint.type);
    const double x = unit_of(joint, units.L), stiffness = units.effort(joint) / x, T = units.T;
    joint.armature *= stiffness * T * T;
    joint.stiffness *= stiffness, joint.damping *= stiffness * T;
    joint.quadratic_stiffness *= stiffness / x;
    joint.rest *= x, joint.lower *= x, joint.upper *= x;
  }
  for (Coupling& coupling : scene.couplings) {
    const double x = unit_of(scene.joints[coupling.joint], units.L);
    for (JointTerm& term : coupling.to) term.ratio *= x / unit_of(scene.joints[term.joint], units.L);
    coupling.offset *= x;
  }
  for (Motor& motor : scene.motors) scale_motor(motor, scene, units);
}

void scale(ContactLaw& law, const Units& units) {
  law.rolling_friction *= units.L, law.torsional_friction *= units.L;
  law.stiffness *= units.force() / units.L, law.damping *= units.force() / units.L * units.T;
  law.dissipation *= units.T / units.L;
}

void scale(Scene& scene, const Units& units) {
  const double L = units.L, T = units.T, M = units.M, stiffness = M / (T * T);
  scene.gravity *= L / (T * T);
  for (Body& body : scene.bodies) {
    body.mass *= M, body.inertia *= M * L * L;
    body.position *= L, body.velocity *= L / T, body.angular_velocity /= T;
    if (body.shape) body.shape = scaled_shape(*body.shape, L);
  }
  for (Spring& spring : scene.springs) {
    spring.point_a *= L, spring.point_b *= L, spring.rest_length *= L;
    spring.stiffness *= stiffness, spring.damping *= stiffness * T, spring.quadratic_stiffness *= stiffness / L;
  }
  scale_joints(scene, units);
  scale(scene.contact_default, units);
  for (ContactPair& pair : scene.contact_pairs) scale(pair.law, units);
  for (TimedForce& force : scene.forces) {
    force.force *= units.force(), force.torque *= units.force() * L, force.point *= L;
    force.from *= T, force.until *= T;
  }
}

bool turns(const Equivalence& how) { return !how.turn.vec().isZero(0); }

}  // namespace

Scene equivalent(Scene scene, const Equivalence& how) {
  if (how.is_mirrored) mirror(scene);
  if (turns(how)) scene = turned(std::move(scene), how.turn);
  if (how.is_reversed) reverse(scene);
  scale(scene, {how.length, how.time, how.mass});
  return scene;
}

void to_equivalent(const Equivalence& how, BodyColumns original, MutableBodyColumns out) {
  const double L = how.length, T = how.time;
  for (std::size_t i = 0; i < original.size(); ++i) {
    BodyState body = original.body(i);
    if (how.is_mirrored) {
      body = {mirrored(body.position), mirrored(body.orientation), mirrored(body.velocity),
              mirrored_axial(body.angular_velocity)};
    }
    if (turns(how)) {
      body = {how.turn * body.position, how.turn * body.orientation, how.turn * body.velocity,
              how.turn * body.angular_velocity};
    }
    body.position *= L, body.velocity *= L / T, body.angular_velocity /= T;
    out.set_body(how.is_reversed ? original.size() - 1 - i : i, body);
  }
}

void to_original(const Equivalence& how, BodyColumns equivalent, MutableBodyColumns out) {
  const double L = how.length, T = how.time;
  const Quat back = how.turn.conjugate();
  for (std::size_t i = 0; i < equivalent.size(); ++i) {
    BodyState body = equivalent.body(how.is_reversed ? equivalent.size() - 1 - i : i);
    body.position /= L, body.velocity *= T / L, body.angular_velocity *= T;
    if (turns(how)) {
      body = {back * body.position, back * body.orientation, back * body.velocity, back * body.angular_velocity};
    }
    if (how.is_mirrored) {
      body = {mirrored(body.position), mirrored(body.orientation), mirrored(body.velocity),
              mirrored_axial(body.angular_velocity)};
    }
    out.set_body(i, body);
  }
}

}  // namespace rigor::inline truth
