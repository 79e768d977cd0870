// Changes of a scene, of a step and of read values that several kinds of faults share.
#pragma once

#include <fmt/format.h>

#include <functional>

#include "adapters/faults/fault.h"

namespace rigor::inline adapters::faulty {

template <typename F>
std::function<void(Scene&)> each_body(F change) {
  return [change](Scene& scene) {
    for (Body& body : scene.bodies) change(body);
  };
}

template <typename F>
std::function<void(Scene&)> each_spring(F change) {
  return [change](Scene& scene) {
    for (Spring& spring : scene.springs) change(spring);
  };
}

template <typename F>
std::function<void(Scene&)> each_force(F change) {
  return [change](Scene& scene) {
    for (TimedForce& force : scene.forces) change(force);
  };
}

// On every moving body, before each step.
template <typename F>
std::function<void(Moment&)> each_moving(F change) {
  return [change](Moment& moment) {
    for (Body& body : moment.scene.bodies) {
      if (!body.fixed) change(body, moment.dt);
    }
  };
}

template <typename F>
std::function<void(MutableBodyColumns, const Scene&)> each_read(F change) {
  return [change](MutableBodyColumns bodies, const Scene&) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      BodyState state = BodyColumns(bodies).body(i);
      change(state);
      bodies.set_body(i, state);
      if (bodies.has_rotation()) bodies.set_rotation(i, matrix_of(state.orientation));
    }
  };
}

// An impulse [N s, in W] at a point of the body [m, in B].
inline void push(Body& body, const Vec3& impulse, const Vec3& point_B) {
  if (body.fixed) return;
  const Mat3 R = matrix_of(body.orientation);
  body.velocity += impulse / body.mass;
  body.angular_velocity += R * body.inertia.inverse() * (R.transpose() * (R * point_B).cross(impulse));
}

inline Fault on_loading(const std::string& name, std::function<void(Scene&)> change) {
  Fault fault{name};
  fault.scene = std::move(change);
  return fault;
}

inline Fault on_stepping(const std::string& name, std::function<void(Moment&)> change) {
  Fault fault{name};
  fault.step = std::move(change);
  return fault;
}

template <typename F>
Fault on_reading(const std::string& name, F change) {
  Fault fault{name};
  fault.read = each_read(change);
  return fault;
}

// A fault by some amount: `pattern` is its name with {} for the amount, `make` applies it.
template <typename Make>
Fault by_amount(const std::string& pattern, double amount, Make make) {
  Fault fault = make(amount);
  fault.name = fmt::format(fmt::runtime(pattern), fmt::format("{:.3g}", amount));
  fault.amount = amount;
  fault.by = [=](double other) { return by_amount(pattern, other, make); };
  return fault;
}

inline Quat w_taken_last(const Quat& q) { return {q.z(), q.w(), q.x(), q.y()}; }  // (x, y, z, w) for (w, x, y, z)

inline double single(double x) { return static_cast<float>(x); }
inline Vec3 single(const Vec3& v) { return v.cast<float>().cast<double>(); }

inline void equal_masses(Scene& scene) {
  double sum = 0, count = 0;
  for (const Body& body : scene.bodies) {
    if (!body.fixed) sum += body.mass, ++count;
  }
  for (Body& body : scene.bodies) body.mass = sum / count;
}

}  // namespace rigor::inline adapters::faulty
