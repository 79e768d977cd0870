// Gravity, and what bodies are and how they begin.
#include <utility>

#include "adapters/faults/changes.h"
#include "adapters/faults/faults.h"

namespace rigor::inline adapters {
namespace {

using namespace faulty;

void scale_off_diagonal(Body& body, double factor) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) body.inertia(r, c) *= r == c ? 1 : factor;
  }
}

// Confuses the vertical axis: z for y, or y for z.
void swap_axes_of_gravity(Scene& scene) { std::swap(scene.gravity.y(), scene.gravity.z()); }

Fault factor_on_bodies(const std::string& pattern, void (*change)(Body&, double)) {
  return by_amount(pattern, 0.1, [=](double percent) {
    return on_loading("", each_body([=](Body& body) { change(body, 1 + percent / 100); }));
  });
}

}  // namespace

std::vector<Fault> body_faults() {
  return {
      by_amount("gravity off by {} %", 0.1,
                [](double percent) { return on_loading("", [=](Scene& s) { s.gravity *= 1 + percent / 100; }); }),
      on_loading("gravity reversed", [](Scene& s) { s.gravity *= -1; }),
      on_loading("gravity left out", [](Scene& s) { s.gravity.setZero(); }),
      on_loading("gravity along another axis", swap_axes_of_gravity),
      factor_on_bodies("mass off by {} %", [](Body& b, double factor) { b.mass *= factor; }),
      on_loading("mass ratio ignored", equal_masses),
      factor_on_bodies("inertia off by {} %", [](Body& b, double factor) { b.inertia *= factor; }),
      on_loading("inertia in the wrong frame", each_body([](Body& b) {
                   const Mat3 R = matrix_of(b.orientation);
                   b.inertia = (R.transpose() * b.inertia * R).eval();
                 })),
      on_loading("inertia's axes in another order", each_body([](Body& b) {
                   b.inertia = Vec3(b.inertia(2, 2), b.inertia(0, 0), b.inertia(1, 1)).asDiagonal();
                 })),
      on_loading("products of inertia left out", each_body([](Body& b) { scale_off_diagonal(b, 0); })),
      on_loading("products of inertia with the other sign", each_body([](Body& b) { scale_off_diagonal(b, -1); })),
      on_loading("every body a sphere",
                 each_body([](Body& b) { b.inertia = Mat3::Identity() * b.inertia.trace() / 3; })),
      on_loading("velocity lost on loading", each_body([](Body& b) { b.velocity.setZero(); })),
      on_loading("velocity taken in the body frame",
                 each_body([](Body& b) { b.velocity = b.orientation * b.velocity; })),
      on_loading("angular velocity taken in the body frame",
                 each_body([](Body& b) { b.angular_velocity = b.orientation * b.angular_velocity; })),
      on_loading("angular velocity taken in degrees",
                 each_body([](Body& b) { b.angular_velocity *= 0.017453292519943295; })),
      on_loading("quaternion order swapped on loading",
                 each_body([](Body& b) { b.orientation = w_taken_last(b.orientation); })),
      on_loading("conjugate rotation on loading",
                 each_body([](Body& b) { b.orientation = b.orientation.conjugate(); })),
  };
}

}  // namespace rigor::inline adapters
