#include "core/scene/turned.h"

namespace rigor::inline scene {
namespace {

void turn_body(Body& body, const Quat& turn) {
  body.position = turn * body.position;
  body.orientation = (turn * body.orientation).normalized();
  body.velocity = turn * body.velocity;
  body.angular_velocity = turn * body.angular_velocity;
  if (!body.shape) return;
  if (auto* plane = std::get_if<Plane>(&*body.shape)) plane->normal = turn * plane->normal;
}

}  // namespace

Scene turned(Scene scene, const Quat& turn) {
  scene.gravity = turn * scene.gravity;
  for (Body& body : scene.bodies) turn_body(body, turn);
  for (Spring& spring : scene.springs) {
    if (spring.a == kWorld) spring.point_a = turn * spring.point_a;
    if (spring.b == kWorld) spring.point_b = turn * spring.point_b;
  }
  for (Joint& joint : scene.joints) {
    for_each_vector(joint.type, [&](const char*, JointVector kind, Vec3& vector) {
      const bool is_in_body = (kind == JointVector::point_of_a && joint.a != kWorld) ||
                              (kind == JointVector::point_of_b && joint.b != kWorld);
      if (!is_in_body) vector = turn * vector;
    });
  }
  for (TimedForce& force : scene.forces) force.force = turn * force.force, force.torque = turn * force.torque;
  return scene;
}

}  // namespace rigor::inline scene
