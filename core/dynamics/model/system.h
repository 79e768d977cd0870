// The bodies of a scene as the Newton–Euler equations see them:
//   m v' = F,   L' = tau,   L = R I_B Rᵀ w   (that is  I_W w' = tau - w x I_W w).
// Constants are computed once. A fixed body has no inverse mass and no inverse inertia, so it never moves.
#pragma once

#include <vector>

#include "core/dynamics/model/body_constants.h"
#include "core/dynamics/model/loads/loads.h"
#include "core/engine/body_table.h"
#include "core/scene/scene.h"

namespace rigor::inline dynamics {

// The principal axes P of a body: I_B = R_BP diag(moments) R_BPᵀ.
struct PrincipalInertia {
  Vec3 moments;  // kg m², ascending
  Quat q_BP;     // P to B
};
PrincipalInertia principal_inertia(const Mat3& inertia_B);

struct Inertia {
  double mass = 0, inverse_mass = 0;                                // kg, 1/kg
  Mat3 inertia_B = Mat3::Zero(), inverse_inertia_B = Mat3::Zero();  // kg m², 1/(kg m²)
  bool fixed = false;
};

class System {
 public:
  explicit System(const Scene& scene);

  std::size_t size() const { return bodies.size(); }

  // Gravity, springs and timed forces over a step [t, t + dt] that begins with `state`.
  void wrenches(BodyColumns state, double t, double dt, Wrenches& out) const {
    loads.evaluate_with_gravity(state, t, dt, out);
  }

  Vec3 scene_gravity;  // m/s²
  std::vector<Inertia> bodies;
  Loads loads;
  BodyConstants constants;  // `bodies` and gravity in columns
};

// w' [rad/s²] under a torque [N m] about the centre of mass; all in W. R takes B to W.
Vec3 angular_acceleration(const Inertia& body, const Mat3& R, const Vec3& w, const Vec3& torque);

// L = R I_B Rᵀ w and back.
Vec3 angular_momentum_of(const Inertia& body, const Mat3& R, const Vec3& w);
Vec3 angular_velocity_of(const Inertia& body, const Mat3& R, const Vec3& L);

// The scene's state at t = 0; a fixed body's velocities are zero.
void set_initial_state(const Scene& scene, MutableBodyColumns state);

}  // namespace rigor::inline dynamics
