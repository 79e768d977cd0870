#include "core/dynamics/model/system.h"

#include <Eigen/LU>

#include "core/base/eigen_of.h"

namespace rigor::inline dynamics {

PrincipalInertia principal_inertia(const Mat3& inertia_B) {
  if (inertia_B.isDiagonal(0)) {
    const Vec3 d = inertia_B.diagonal();
    if (d.x() <= d.y() && d.y() <= d.z()) return {d, Quat::Identity()};
  }
  const auto [moments, vectors] = eigen_of(inertia_B);
  Mat3 axes = vectors;
  if (axes.determinant() < 0) axes.col(2) *= -1;
  return {moments, Quat(axes).normalized()};
}

System::System(const Scene& scene) : scene_gravity(scene.gravity), loads(scene) {
  for (const Body& body : scene.bodies) {
    Inertia inertia;
    inertia.fixed = body.fixed;
    if (!body.fixed) {
      inertia.mass = body.mass;
      inertia.inverse_mass = 1 / body.mass;
      inertia.inertia_B = body.inertia;
      inertia.inverse_inertia_B = body.inertia.inverse();
    }
    bodies.push_back(inertia);
  }
  constants = BodyConstants(bodies, scene_gravity);
}

Vec3 angular_acceleration(const Inertia& body, const Mat3& R, const Vec3& w, const Vec3& torque) {
  const Vec3 w_B = R.transpose() * w;
  const Vec3 rest_B = R.transpose() * torque - w_B.cross(body.inertia_B * w_B);
  return R * (body.inverse_inertia_B * rest_B);
}

Vec3 angular_momentum_of(const Inertia& body, const Mat3& R, const Vec3& w) {
  return R * (body.inertia_B * (R.transpose() * w));
}

Vec3 angular_velocity_of(const Inertia& body, const Mat3& R, const Vec3& L) {
  return R * (body.inverse_inertia_B * (R.transpose() * L));
}

void set_initial_state(const Scene& scene, MutableBodyColumns state) {
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    const Body& body = scene.bodies[i];
    state.set_position(i, body.position);
    state.set_orientation(i, body.orientation);
    state.set_velocity(i, body.fixed ? Vec3::Zero() : body.velocity);
    state.set_angular_velocity(i, body.fixed ? Vec3::Zero() : body.angular_velocity);
    if (state.has_rotation()) state.set_rotation(i, matrix_of(body.orientation));
  }
}

}  // namespace rigor::inline dynamics
