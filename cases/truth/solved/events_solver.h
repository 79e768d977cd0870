// The numbers behind the truth 'events': the motion of a scene with contacts by the core's contact by events, solved in
// ways that differ in step, integrator and the speed at which bounces end, and how far these are apart.
#pragma once

#include "cases/truth/solved/reference_solver.h"

namespace rigor {

// Of ReferenceSolution: a node every step, thirteen numbers a body as BodyTable lays them out, and one more: 1 if no
// event lies before the next node. Complete or not, its errors say how far it may be relied on.
ReferenceSolution solve_events(const Scene& scene, double duration);

// The state at t: between nodes by Hermite's cubic of positions and turns, or, where an event lies between, by a step
// of the method from the node before.
void state_at(const ReferenceSolution& solution, const Scene& scene, double t, MutableBodyColumns out);

}  // namespace rigor
