// What joints do wrong: they come apart, chains of them stretch, and they take energy.
#pragma once

#include "cases/analysis/diagnosis.h"

namespace rigor {

// Joints come apart: the value is the gap [m] at the coarsest step, `beside` the gap within the first second, and the
// cause the engine's share of a gap that a step takes back.
inline constexpr const char* kJointsPart = "joint gap";
// A solver that sweeps over the joints leaves a chain longer than another run of the same engine does, which solves for
// all of them at once or sweeps more often: the second of the runs, whose gap [m] is `beside`.
inline constexpr const char* kChainStretches = "chain";
// A mechanism that keeps its energy loses some of it, by a share that falls as dt, of first order: the value, at the
// coarsest step. `beside` is the order between the two finest.
inline constexpr const char* kJointsTakeEnergy = "joint energy";

// One run and one topic each, by run.
std::vector<Diagnosis> joint_diagnoses(const Results& results, const CaseResult& result);

// The largest reach [m] from a body's centre to a joint of its, or the largest radius of gyration where that is more (a
// slider holds the centre itself): what a gap is large or small beside.
double joint_size(const Scene& scene);

// How many joints follow each other at most, from what stands still or else from an end of the mechanism.
int joints_in_a_row(const Scene& scene);

// The largest ratio of the masses of two bodies that a joint holds together; 1 if all are held to what stands still.
double mass_ratio(const Scene& scene);

}  // namespace rigor
