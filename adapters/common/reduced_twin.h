// Semi-implicit Euler in the coordinates u of a tree's joints and of free bodies, for the twins of engines that step
// so:
//   u1' = u0' + dt u0'',   u1 = u0 + dt u1',   then every body's pose and velocities from u1 and u1'.
// u0'' are exact: here of bodies in W that the core's joints hold (joints.h), in an engine of Featherstone's algorithm.
// Along a hinge, a slider and a universal joint u is an angle or a displacement. A ball joint's rate is the child's
// angular velocity against its parent as the child sees it. A free body's own are v in W, and w: in W as well as in its
// own frame, for a turn about w leaves w what it is.
// Everything is taken from the bodies' motion at the start of the step, which the joints hold to rounding.
#pragma once

#include "core/dynamics/integrators/integrator.h"

namespace rigor {

// An orientation after dt of turning by w, which is seen by what turns: of a free body in W, of what hangs on a ball
// joint against what it was at t = 0.
using TurnOverStep = Quat (*)(const Quat& from, const Vec3& w, double dt);

inline Quat exact_turn(const Quat& from, const Vec3& w, double dt) { return from * rotation_by(dt * w); }

std::unique_ptr<Stepper> make_reduced_twin(const StepperParts& parts, TurnOverStep turn);

}  // namespace rigor
