// Finds errors of joints: gaps, chains that stretch, and loss of energy.
#pragma once

#include "cases/analysis/diagnosis.h"

namespace rigor::inline analysis {

// Joints come apart. The value is the gap [m] at the coarsest step, and `beside` the gap within the first second. The
// cause is the share of a gap that the engine corrects in one step.
inline constexpr const char* kJointsPart = "joint gap";
// A solver that sweeps over the joints stretches a chain. `beside` is the gap [m] of the second run: it is of the same
// engine, and solves for all joints at once or sweeps more often.
inline constexpr const char* kChainStretches = "chain";
// A mechanism without losses loses energy, to first order in dt. The value is the share lost at the coarsest step, and
// `beside` the order between the two finest steps.
inline constexpr const char* kJointsTakeEnergy = "joint energy";

// One run and one topic in each, sorted by run.
std::vector<Diagnosis> joint_diagnoses(const Results& results, const CaseResult& result);

// The scale of a gap [m]: the largest distance from a body's centre to one of its joints, or the largest radius of
// gyration if that is more. A slider may act at the centre itself.
double joint_size(const Scene& scene);

// The longest row of joints, from a body that stands still or else from an end of the mechanism.
int joints_in_a_row(const Scene& scene);

// The largest mass ratio of two bodies that share a joint; 1 if all joints lead to bodies that stand still.
double mass_ratio(const Scene& scene);

}  // namespace rigor::inline analysis
