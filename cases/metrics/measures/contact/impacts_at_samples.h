// Pairs of bodies whose impact falls exactly on a sample. Rounding decides whether its impulse belongs to the step
// before the sample or to the one after it. Two runs that are both right may differ in this, so only the mean of both
// steps can be compared.
#pragma once

#include <set>

#include "cases/metrics/measures/contact/pair_forces.h"

namespace rigor::inline metric {

// Bodies that touch and at the same time approach or part, faster than bodies at rest do in a step of dt, and all that
// touch these, one after another: an impulse may pass through them.
std::set<BodyPair> pairs_with_impact_at(const Scene& scene, BodyColumns bodies, double dt);

}  // namespace rigor::inline metric
