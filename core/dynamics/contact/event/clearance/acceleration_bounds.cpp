#include "core/dynamics/contact/event/clearance/acceleration_bounds.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline dynamics {

AccelerationBounds::AccelerationBounds(const System& system) : system_(system) {
  for (const Inertia& body : system.bodies) {
    moments_.push_back(body.fixed ? Vec3::Zero().eval() : principal_inertia(body.inertia_B).moments);
  }
}

bool AccelerationBounds::find(BodyColumns from, BodyColumns to, double t, double h,
                              const std::vector<Loading>& contacts) {
  const Ends ends{from, to, t, h};
  load_by_forces(ends, contacts);
  guess_.assign(system_.size(), {});
  apply(ends, guess_, bounds_);
  guess_twice(ends);
  // If only rounding pulls, as with springs at their rest lengths, twice the bound encloses nothing.
  constexpr double kNextToNothing = 1e-6;
  const auto was_nothing = [&](std::size_t i) {
    return guess_[i].linear < kNextToNothing * bounds_[i].linear ||
           guess_[i].angular < kNextToNothing * bounds_[i].angular;
  };
  bool any_was_nothing = false;
  for (std::size_t i = 0; i < bounds_.size(); ++i) any_was_nothing = any_was_nothing || was_nothing(i);
  if (any_was_nothing) guess_twice(ends);
  for (std::size_t i = 0; i < bounds_.size(); ++i) {
    if (!(bounds_[i].linear <= guess_[i].linear && bounds_[i].angular <= guess_[i].angular)) return false;
  }
  return true;
}

// Twice the found bound, and the bound that follows from it.
void AccelerationBounds::guess_twice(const Ends& ends) {
  for (AccelerationBound& bound : bounds_) bound.linear *= 2, bound.angular *= 2;
  guess_.swap(bounds_);
  apply(ends, guess_, bounds_);
}

// Gravity, contacts and the timed forces; none of these begins or ends on the way.
void AccelerationBounds::load_by_forces(const Ends& ends, const std::vector<Loading>& contacts) {
  Wrenches constant(system_.size());
  std::vector<double> turning(system_.size());  // N m, of forces whose arms turn with the body
  for (std::size_t i = 0; i < system_.size(); ++i) constant[i].force = system_.bodies[i].mass * system_.scene_gravity;
  system_.loads.for_each_acting(ends.t, ends.h, [&](const TimedForce& force, double) {
    constant[force.body].force += force.force, constant[force.body].torque += force.torque;
    turning[force.body] += force.point.norm() * force.force.norm();
  });
  by_forces_.clear();
  for (std::size_t i = 0; i < system_.size(); ++i) {
    by_forces_.push_back(
        {constant[i].force.norm() + contacts[i].force, constant[i].torque.norm() + turning[i] + contacts[i].torque});
  }
}

void AccelerationBounds::load_by_springs(const Ends& ends, const Bounds& guess) {
  for (const Spring& spring : system_.loads.springs()) {
    double extension = 0, speed = 0;
    for (const BodyColumns& state : {ends.from, ends.to}) {
      const PointMotion a = point_motion(state, spring.a, spring.point_a),
                        b = point_motion(state, spring.b, spring.point_b);
      extension = std::max(extension, std::abs((b.position - a.position).norm() - spring.rest_length));
      speed = std::max(speed, (b.velocity - a.velocity).norm());
    }
    if (spring.a != kWorld) speed += 0.5 * ends.h * guess[spring.a].of_point(spring.point_a.norm());
    if (spring.b != kWorld) speed += 0.5 * ends.h * guess[spring.b].of_point(spring.point_b.norm());
    const double tension = elastic_effort(spring, extension + 0.5 * ends.h * speed) + spring.damping * speed;
    for (const auto& [body, arm] :
         {std::pair(spring.a, spring.point_a.norm()), std::pair(spring.b, spring.point_b.norm())}) {
      if (body != kWorld) loading_[body].force += tension, loading_[body].torque += tension * arm;
    }
  }
}

// The largest |w| whose energy E is at most, and whose momentum L is at least, what a torque can make of the states'
// values. It is the largest sum of the squares u_i of w's principal components under sum I_i u_i <= 2 E and sum I_i²
// u_i >= L². The maximum has one nonzero component, or two that meet both bounds.
double AccelerationBounds::largest_spin(std::size_t body, const Ends& ends, double torque) const {
  const Vec3& I = moments_[body];
  double energy = 0, momentum = HUGE_VAL, spin = 0;  // 2 E, L
  for (const BodyColumns& state : {ends.from, ends.to}) {
    const Vec3 w = state.angular_velocity(body), L = angular_momentum_of(system_.bodies[body], state.rotation(body), w);
    energy = std::max(energy, w.dot(L)), momentum = std::min(momentum, L.norm()), spin = std::max(spin, w.norm());
  }
  const double most = std::sqrt(energy) + 0.5 * ends.h * torque / std::sqrt(I[0]);
  energy = most * most;
  momentum = std::max(0.0, momentum - 0.5 * ends.h * torque);
  double square = spin * spin;
  for (int i = 0; i < 3; ++i) {
    if (I[i] * energy >= momentum * momentum) square = std::max(square, energy / I[i]);
    for (int j = i + 1; j < 3; ++j) {
      const double u_j = (momentum * momentum - I[i] * energy) / (I[j] * (I[j] - I[i]));
      const double u_i = (energy - I[j] * u_j) / I[i];
      if (u_i >= 0 && u_j >= 0) square = std::max(square, u_i + u_j);
    }
  }
  return std::sqrt(square);
}

void AccelerationBounds::apply(const Ends& ends, const Bounds& guess, Bounds& out) {
  loading_ = by_forces_;
  load_by_springs(ends, guess);
  out.assign(system_.size(), {});
  for (std::size_t i = 0; i < system_.size(); ++i) {
    const Inertia& body = system_.bodies[i];
    if (body.fixed) continue;
    const double spin = largest_spin(i, ends, loading_[i].torque);
    const double precession = 0.5 * (moments_[i][2] - moments_[i][0]) * spin * spin;
    out[i] = {body.inverse_mass * loading_[i].force, (loading_[i].torque + precession) / moments_[i][0], spin};
  }
}

}  // namespace rigor::inline dynamics
