// The inner loops of contact by sequential impulses (contact_rows.h), several rows or bodies at once, in the
// instruction set of the table that is in use (kernels.h), with the same bits in each. Groups that are given together
// share no moving body.
#pragma once

#include <utility>

#include "core/dynamics/kernels/contact_rows.h"
#include "core/dynamics/kernels/kernels.h"

namespace rigor {

struct ContactKernels {
  // Of the pairs of places (records: position, reach, velocity, radius) the numbers of those whose reaches meet to
  // `near`, which has room for all: how many they are. And the contacts of such pairs, as if both were balls, before
  // dt; balls farther apart than a margin, in radii of the smaller, and than they can meet in dt, exceed what is kept.
  std::size_t (*near_pairs)(const double* places, const std::pair<int, int>* pairs, std::size_t count,
                            std::int32_t* near);
  void (*ball_contacts)(const double* places, const std::pair<int, int>* pairs, const std::int32_t* near,
                        std::size_t count, double dt, double margin, BallContacts* contacts);
  // Velocities to the state, and to `pushes` what they are more than those that were there: what all impulses of a
  // sub-step have done. And to records with these on top, which is as if each impulse were applied to them.
  void (*scatter_pushed)(const Bodies&, const double* velocities, double* state, double* pushes);
  void (*gather_pushed)(const Bodies&, const double* state, const double* pushes, double* velocities);
  // Positions and orientations integrated over h with what the records' velocities differ by from the state's; and how
  // the bodies have then moved since `start`, to records.
  void (*integrate_corrections)(const Bodies&, const double* velocities, double h, double* state, const double* start,
                                double* displacements);
  // Effective masses.
  void (*prepare_rows)(const RowGroup*, std::size_t count, const SolverBodies&);
  // Gaps, approach speeds and biases of a sub-step; and the rows that meet in it faster than the restitution threshold
  // to `impacts`, which has room for all: how many they are. Numbers of groups count from `first`.
  std::size_t (*prepare_bias)(const RowGroup* first, std::size_t begin, std::size_t end, const SolverBodies&,
                              const SolverParameters&, RowPlace* impacts);
  // Each row's impulse as it is, the biased solve, and the solve without bias.
  void (*warm_start)(const RowGroup*, std::size_t count, const SolverBodies&);
  void (*solve_with_bias)(const RowGroup*, std::size_t count, const SolverBodies&, const SolverParameters&);
  void (*relax)(const RowGroup*, std::size_t count, const SolverBodies&);
  // One of several sweeps, biased or not: whether any row changed a velocity by more than the tolerance.
  bool (*sweep_with_bias)(const RowGroup*, std::size_t count, const SolverBodies&, const SolverParameters&);
  bool (*sweep_without_bias)(const RowGroup*, std::size_t count, const SolverBodies&, const SolverParameters&);
};

const ContactKernels& contact_kernels();

}  // namespace rigor
