// The numbers behind the truth 'events': the motion of a scene with contacts by the core's contact by events, solved in
// several ways. Ways differ in the integrator, its tolerance or step, the thresholds of contact, and the equivalent
// scene in which they see the motion. The finest way is the truth, and the distance of the others is its error.
#pragma once

#include "cases/truth/solved/reference_solver.h"

namespace rigor::inline truth {

// As in ReferenceSolution: nodes at equal distances with thirteen numbers per body, laid out as in BodyTable. One more
// number is 1 if no event lies before the next node. The errors say how far the solution is reliable, complete or not.
ReferenceSolution solve_events(const Scene& scene, double duration);

// The state at t. Between nodes it uses Hermite's cubic of positions and rotations or, where an event lies between, a
// step of the method from the node before.
void state_at(const ReferenceSolution& solution, const Scene& scene, double t, MutableBodyColumns out);

}  // namespace rigor::inline truth
