// The code that each kernels_*.cpp compiles for its instruction set, in its own namespace, so that no two of them share
// a function. No other header may be included after the instruction set is selected. Its definitions would be compiled
// for that set, and could be linked into the rest of the program.
#define RIGOR_INLINE __attribute__((always_inline)) inline
#define RIGOR_LAMBDA __attribute__((always_inline))

namespace rigor::inline dynamics {
namespace RIGOR_LANES_OF {
namespace {

// Up to so many bodies, and springs, are taken one at a time.
inline constexpr std::size_t kFewBodies = 1, kFewSprings = 2;

#include "core/dynamics/kernels/lanes-inl.h"
// which this is built on:
#include "core/dynamics/kernels/lane_math-inl.h"
// and on these:
#include "core/dynamics/kernels/body_kernels-inl.h"
// and on these:
#include "core/dynamics/kernels/contact_record_kernels-inl.h"
#include "core/dynamics/kernels/moser_veselov_kernel-inl.h"
#include "core/dynamics/kernels/sphere_kernels-inl.h"
#include "core/dynamics/kernels/spring_kernel-inl.h"
#include "core/dynamics/kernels/stage_kernels-inl.h"
// and on these:
#include "core/dynamics/kernels/ball_kernels-inl.h"
#include "core/dynamics/kernels/contact_row_kernels-inl.h"
#include "core/dynamics/kernels/multistep_kernels-inl.h"

}  // namespace

extern const Kernels kTable;
const Kernels kTable = {
    .name = RIGOR_LANES_NAME,
    .kick = kick,
    .drift = drift,
    .explicit_step = explicit_step,
    .momentum_of = momentum_of,
    .velocity_of = velocity_of,
    .momentum_kick = momentum_kick,
    .free_drift = free_drift,
    .moser_veselov_drift = moser_veselov_drift,
    .quaternion_stage = quaternion_stage,
    .rotation_vector_stage = rotation_vector_stage,
    .motion_of = motion_of,
    .rates_at = rates_at,
    .combine = combine,
    .relative_size = relative_size,
    .sums_of_older = sums_of_older,
    .adams_advance = adams_advance,
    .springs = springs,
    .have_stayed = have_stayed,
    .below_plane = below_plane,
    .gather_velocities = gather_velocities,
    .scatter_velocities = scatter_velocities,
    .gather_inverse_inertias = gather_inverse_inertias,
};

extern const ContactKernels kContactTable;
const ContactKernels kContactTable = {
    .near_pairs = near_pairs,
    .ball_contacts = ball_contacts,
    .scatter_pushed = scatter_pushed,
    .gather_pushed = gather_pushed,
    .integrate_corrections = integrate_corrections,
    .prepare_rows = prepare_rows,
    .prepare_bias = prepare_bias,
    .warm_start = warm_start,
    .solve_with_bias = solve_with_bias,
    .relax = relax,
    .sweep_with_bias = sweep_with_bias,
    .sweep_without_bias = sweep_without_bias,
};

extern const BallKernels kBallTable;
const BallKernels kBallTable = {
    .gather_poses = gather_poses,
    .prepare = prepare_balls,
    .assemble = assemble_balls,
    .push_and_drift = push_and_drift,
    .measure = measure_balls,
};

}  // namespace RIGOR_LANES_OF
}  // namespace rigor::inline dynamics
