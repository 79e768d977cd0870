#include "core/scene/turned.h"

namespace rigor {
namespace {

void turn_body(Body& body, const Quat& turn) {
  body.position = turn * body.position;
  body.orientation = (turn * body.orientation).normalized();
  body.velocity = turn * body.velocity;
  body.angular_velocity = turn * body.angular_velocity;
  if (!body.shape) return;
  if (auto* plane = std::get_if<Plane>(&*body.shape)) plane->normal = turn * plane->normal;
}

// Of a joint only what is given in W turns.
struct TurnJoint {
  const Quat& turn;
  void operator()(BallJoint& joint) const { joint.anchor = turn * joint.anchor; }
  void operator()(HingeJoint& joint) const { joint.anchor = turn * joint.anchor, joint.axis = turn * joint.axis; }
  void operator()(SliderJoint& joint) const { joint.axis = turn * joint.axis; }
  void operator()(UniversalJoint& joint) const {
    joint.anchor = turn * joint.anchor, joint.axis = turn * joint.axis, joint.axis2 = turn * joint.axis2;
  }
  void operator()(FixedJoint&) const {}
  void operator()(DistanceJoint&) const {}
};

}  // namespace

Scene turned(Scene scene, const Quat& turn) {
  scene.gravity = turn * scene.gravity;
  for (Body& body : scene.bodies) turn_body(body, turn);
  for (Spring& spring : scene.springs) {
    if (spring.a == kWorld) spring.point_a = turn * spring.point_a;
    if (spring.b == kWorld) spring.point_b = turn * spring.point_b;
  }
  for (Joint& joint : scene.joints) {
    std::visit(TurnJoint{turn}, joint.type);
    if (auto* distance = std::get_if<DistanceJoint>(&joint.type)) {
      if (joint.a == kWorld) distance->point_a = turn * distance->point_a;
      if (joint.b == kWorld) distance->point_b = turn * distance->point_b;
    }
  }
  for (TimedForce& force : scene.forces) force.force = turn * force.force, force.torque = turn * force.torque;
  return scene;
}

}  // namespace rigor
