// The inner loops of ball joints and hinges (ball_rows.h), for several pins or bodies at once. They use the instruction
// set of the table in use (kernels.h), with the same bits in each.
#pragma once

#include "core/dynamics/kernels/ball_rows.h"
#include "core/dynamics/kernels/kernels.h"

namespace rigor::inline dynamics {

struct BallKernels {
  // Positions and orientations to records.
  void (*gather_poses)(const Bodies&, const double* state, double* poses);
  // Arms in W, and the right side of the equations for the impulse that closes the pins h [s] later.
  void (*prepare)(const BallRows&, const double* poses, const double* velocities, double h);
  // The Delassus matrix for those arms: its diagonal, and the blocks of both kinds of couplings.
  void (*assemble)(const BallRows&);
  // An impulse at the poses of `start` and a drift over dt, to `end` and to its records.
  void (*push_and_drift)(const Bodies&, const double* start, const double* impulses, const double* inverse_inertias,
                         Turn turn, double dt, double* end, double* poses);
  // Reaches, and the right side for the gaps at these poses; returns the largest component of a gap [m].
  double (*measure)(const BallRows&, const double* poses, double h);
};

const BallKernels& ball_kernels();

}  // namespace rigor::inline dynamics
