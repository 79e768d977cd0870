// Errors of joints: they open, chains of them stretch, and they lose energy.
#pragma once

#include "cases/analysis/diagnosis.h"

namespace rigor {

// Joints open. The value is the gap [m] at the coarsest step, `beside` the gap within the first second. The cause is
// the share of a gap that the engine corrects per step.
inline constexpr const char* kJointsPart = "joint gap";
// A solver that sweeps over the joints leaves a chain longer than another run of the same engine, which solves for all
// joints at once or with more sweeps. The other is the second of the runs, and `beside` is its gap [m].
inline constexpr const char* kChainStretches = "chain";
// A mechanism that conserves its energy loses some of it, by a share that falls as dt, of first order. The value is
// that of the coarsest step, `beside` the order between the two finest.
inline constexpr const char* kJointsTakeEnergy = "joint energy";

// One run and one topic each, by run.
std::vector<Diagnosis> joint_diagnoses(const Results& results, const CaseResult& result);

// The scale of gaps: the largest reach [m] from a body's centre to one of its joints, or the largest radius of gyration
// if that is larger (a slider holds the centre itself).
double joint_size(const Scene& scene);

// The largest number of joints in a row, from a fixed body or else from an end of the mechanism.
int joints_in_a_row(const Scene& scene);

// The largest mass ratio of two jointed bodies; 1 if all are joined to fixed bodies.
double mass_ratio(const Scene& scene);

}  // namespace rigor
