#include "core/dynamics/model/energy.h"

#include "core/dynamics/model/joint_coordinate.h"

namespace rigor::inline dynamics {
namespace {

Mat3 inertia_in_world(const Body& body, BodyColumns bodies, std::size_t i) {
  const Mat3 R = bodies.rotation(i);
  return R * body.inertia * R.transpose();
}

Vec3 point_in_world(BodyColumns bodies, int body, const Vec3& point) {
  return body == kWorld ? point : Vec3(bodies.position(body) + bodies.rotation(body) * point);
}

}  // namespace

double kinetic_energy_of(const Scene& scene, BodyColumns bodies, std::size_t i) {
  const Body& body = scene.bodies[i];
  if (body.fixed) return 0;
  const Vec3 w = bodies.angular_velocity(i);
  return 0.5 * body.mass * bodies.velocity(i).squaredNorm() + 0.5 * w.dot(inertia_in_world(body, bodies, i) * w);
}

double kinetic_energy(const Scene& scene, BodyColumns bodies) {
  double sum = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) sum += kinetic_energy_of(scene, bodies, i);
  for (const Joint& joint : scene.joints) {
    if (joint.armature == 0) continue;
    const double rate = JointCoordinate(scene, joint).at(bodies).rate;
    sum += 0.5 * joint.armature * rate * rate;
  }
  return sum;
}

double potential_energy(const Scene& scene, BodyColumns bodies) {
  double sum = 0;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!scene.bodies[i].fixed) sum -= scene.bodies[i].mass * scene.gravity.dot(bodies.position(i));
  }
  for (const Spring& spring : scene.springs) {
    const Vec3 line =
        point_in_world(bodies, spring.b, spring.point_b) - point_in_world(bodies, spring.a, spring.point_a);
    const double stretch = line.norm() - spring.rest_length;
    sum += elastic_energy(spring, stretch);
  }
  for (const Joint& joint : scene.joints) {
    if (joint.stiffness == 0) continue;
    const double stretch = JointCoordinate(scene, joint).at(bodies).x - joint.rest;
    sum += elastic_energy(joint, stretch);
  }
  return sum;
}

Vec3 linear_momentum(const Scene& scene, BodyColumns bodies) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (!scene.bodies[i].fixed) sum += scene.bodies[i].mass * bodies.velocity(i);
  }
  return sum;
}

Vec3 angular_momentum(const Scene& scene, BodyColumns bodies, const Vec3& about_W) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    if (body.fixed) continue;
    sum += body.mass * (bodies.position(i) - about_W).cross(bodies.velocity(i)) +
           inertia_in_world(body, bodies, i) * bodies.angular_velocity(i);
  }
  return sum;
}

}  // namespace rigor::inline dynamics
