// The inner loops of contact by sequential impulses (contact_rows.h), for several rows or bodies at once. They use the
// instruction set of the table in use (kernels.h), with the same bits in each. Groups that are passed together share no
// moving body.
#pragma once

#include <utility>

#include "core/dynamics/kernels/contact_rows.h"
#include "core/dynamics/kernels/kernels.h"

namespace rigor::inline dynamics {

struct ContactKernels {
  // near_pairs: writes the numbers of the pairs of places (records: position, reach, velocity, radius) whose reaches
  // overlap to `near`, which has room for all, and returns their count. ball_contacts: the contacts of such pairs
  // within dt, as if both were balls. Balls farther apart than a margin, in radii of the smaller one, that cannot meet
  // in dt have a positive excess.
  std::size_t (*near_pairs)(const double* places, const std::pair<int, int>* pairs, std::size_t count,
                            std::int32_t* near);
  void (*ball_contacts)(const double* places, const std::pair<int, int>* pairs, const std::int32_t* near,
                        std::size_t count, double dt, double margin, BallContacts* contacts);
  // scatter_pushed: writes velocities to the state, and their change, the effect of all impulses of a sub-step, to
  // `pushes`. gather_pushed: adds `pushes` to the records' velocities, as if each impulse were applied to them.
  void (*scatter_pushed)(const Bodies&, const double* velocities, double* state, double* pushes);
  void (*gather_pushed)(const Bodies&, const double* state, const double* pushes, double* velocities);
  // Integrates positions and orientations over h with the difference of the velocities in records and state. Writes the
  // bodies' displacements since `start` to records.
  void (*integrate_corrections)(const Bodies&, const double* velocities, double h, double* state, const double* start,
                                double* displacements);
  // Effective masses.
  void (*prepare_rows)(const RowGroup*, std::size_t count, const SolverBodies&);
  // Computes gaps, approach speeds and biases of a sub-step. Writes the rows that meet in it faster than the
  // restitution threshold to `impacts`, which has room for all, and returns their count. Numbers of groups count from
  // `first`.
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

}  // namespace rigor::inline dynamics
