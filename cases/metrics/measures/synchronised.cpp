#include "cases/metrics/measures/synchronised.h"

namespace rigor {

Synchroniser::Synchroniser(const Scene& scene, double dt, double stagger) : system_(scene), advance_(stagger * dt) {
  if (!scene.joints.empty() && advance_ != 0) joints_.emplace(scene);
}

void Synchroniser::apply(double time, MutableBodyColumns bodies) {
  if (advance_ == 0) return;
  system_.wrenches(bodies, time, 0, wrenches_);
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const Inertia& body = system_.bodies[i];
    if (body.fixed) continue;
    const Vec3 w = bodies.angular_velocity(i);
    bodies.set_velocity(i, bodies.velocity(i) + advance_ * body.inverse_mass * wrenches_[i].force);
    bodies.set_angular_velocity(i,
                                w + advance_ * angular_acceleration(body, bodies.rotation(i), w, wrenches_[i].torque));
  }
  if (joints_) joints_->project_velocities(bodies);
}

}  // namespace rigor
