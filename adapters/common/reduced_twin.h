// Semi-implicit Euler in the coordinates u of a tree's joints and of free bodies, for the twins of engines that step
// so:
//   u1' = u0' + dt u0'',   u1 = u0 + dt u1',   then every body's pose and velocities from u1 and u1'.
// u0'' are exact. Here they come from bodies in W that the core's joints hold (joints.h), in an engine from
// Featherstone's algorithm. Along a hinge, a slider and a universal joint u is an angle or a displacement. A ball
// joint's rate is the child's angular velocity relative to its parent in the child's frame. A free body has v and w in
// W; w is equal in its own frame, because a rotation about w does not change w. All values come from the bodies' motion
// at the start of the step, which satisfies the joints to rounding.
#pragma once

#include "core/dynamics/integrators/integrator.h"

namespace rigor::inline adapters {

// An orientation after dt of rotation with w, in the rotating frame: for a free body relative to W, on a ball joint
// relative to its orientation at t = 0.
using TurnOverStep = Quat (*)(const Quat& from, const Vec3& w, double dt);

inline Quat exact_turn(const Quat& from, const Vec3& w, double dt) { return from * rotation_by(dt * w); }

std::unique_ptr<Stepper> make_reduced_twin(const StepperParts& parts, TurnOverStep turn);

}  // namespace rigor::inline adapters
