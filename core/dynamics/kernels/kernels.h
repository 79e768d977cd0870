// The inner loops of the core over columns of bodies (body_table.h), several bodies at once in the lanes of a vector
// register. One source (*-inl.h) is compiled for plain x86-64 (or the machine's own set), AVX2 and AVX-512. The program
// selects the widest supported set at start. Lanes are independent and no product is fused with a sum, so every path
// gives the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

#include "core/engine/body_column.h"

namespace rigor::inline dynamics {

// Columns of a body's constants; body_constants.h fills them.
enum ConstantColumn {
  kInverseMass = 0,      // 1/kg, 0 for a fixed body
  kMoves = 1,            // 1, or 0 for a fixed body
  kGyro = 2,             // (I_y - I_z)/I_x and so on round, for an inertia that is diagonal in B
  kInertia = 5,          // xx, yy, zz, xy, xz, yz [kg m²]
  kInverseInertia = 11,  // the same of its inverse
  kAxes = 17,            // principal axes to B: w, x, y, z
  kInverseMedian = 21,   // 1/a, a the median principal moment
  kExcessLow = 22,       // 1/b - 1/a of the smallest,
  kExcessHigh = 23,      // and of the largest
  kConstantColumns = 24
};

// Columns of a wrench: force [N], torque about the centre of mass [N m], both in W.
enum WrenchColumn { kForce = 0, kTorque = 3, kWrenchColumns = 6 };

// Columns that a step carries beside the state: the angular momentum in W [kg m²/s], a rotation vector [rad].
enum CarriedColumn { kMomentum = 0, kTurned = 3, kCarriedColumns = 6 };

// Doubles of a record: a body's values side by side, for what looks at bodies in no order.
inline constexpr std::size_t kRecord = 8;

// A block of bodies. All tables of one system have the same stride. `begin` is a multiple of kRowsPerLine.
struct Bodies {
  std::size_t begin = 0, end = 0, stride = 0;
  const double* constants = nullptr;
  double gravity[3] = {0, 0, 0};  // m/s²
  bool has_gravity = false, has_fixed = false;
  bool diagonal = false;   // every inertia is diagonal in its B
  bool principal = false;  // every B is its body's principal axes, moments ascending
  bool round = false;      // every inertia is the same about all axes
};

// How a rotation by dt w is made: exactly, or by q + dt/2 (0, w) q, normalised.
enum class Turn { exponential, additive };

// Where a Runge–Kutta stage stands in its step.
enum class Stage { first, middle, last };

struct StageTables {
  double* state;    // at the start of the step; after the last stage at its end
  double* stage;    // at which this stage's rates are taken, and then the next one's
  double* sum;      // the start plus the weighted rates: x, orientation (or rotation vector), v, L
  double* carried;  // L at the start of the step, the stage's rotation vector
};

// Data of an Adams method: x, orientation, v, L, laid out as a body's motion, or their rates.
inline constexpr std::size_t kAdamsRates = 7;
struct AdamsTables {
  double* y;                                  // at the last instant
  double *older_predictor, *older_corrector;  // the weighted sums of the rates but the newest
  double* known;                              // y + h times the corrector's sum without the rates at the end
  std::size_t stride;                         // of the four and of rates; `stage` has that of the bodies
  double* stage;                              // the motion at which the rates at the end are taken
  double h;                                   // s
};
struct AdamsRates {
  const double* rates[kAdamsRates - 1];  // from the second newest after the step back in time
  const double *predictor, *corrector;   // the weights of all, the newest first
};
struct AdamsWeights {
  double predictor, corrector;  // of the newest rates
  double at_end;                // the corrector's, for the rates at the end
};

// The rates that adams_advance() continues with: those in the table; those at the stage, by which it first corrects y;
// or those at y itself with the forces there.
enum class AdamsRatesFrom { table, stage, y };

// A block of springs, for the force on b's point and the torques on both bodies (see loads.cpp for the law).
struct Springs {
  std::size_t begin = 0, end = 0, stride = 0;
  const double* constants = nullptr;              // columns of SpringColumn
  const std::int32_t *a = nullptr, *b = nullptr;  // rows of the bodies; 0 for the world
  bool damped = false, quadratic = false;
};
enum SpringColumn {
  kPointA = 0,  // m, in a's frame
  kPointB = 3,  // m, in b's frame
  kAMoves = 6,  // 1 for a body, 0 for the world
  kBMoves = 7,
  kStiffness = 8,    // N/m
  kDamping = 9,      // N s/m
  kRestLength = 10,  // m
  kQuadratic = 11,   // N/m²
  kSpringColumns = 12
};
enum PullColumn { kPull = 0, kTorqueA = 3, kTorqueB = 6, kPullColumns = 9 };

// Columns of spheres, row by row with the bodies'. The radius is minus infinity if a body is no sphere. The found
// position is the centre at the last search for pairs [m].
enum SphereColumn { kRadius = 0, kFoundAt = 1, kSphereColumns = 4 };

// `wrench` is null if only gravity acts. Steps are in s.
struct Kernels {
  const char* name;
  // v and w over dt at a fixed pose: v += dt F/m, w += dt I⁻¹ (tau - w x I w).
  void (*kick)(const Bodies&, double* state, const double* wrench, double dt);
  // x += dt v, and a turn by dt w.
  void (*drift)(const Bodies&, double* state, Turn turn, double dt);
  // Both from the state at the start of the step.
  void (*explicit_step)(const Bodies&, double* state, const double* wrench, Turn turn, double dt);
  // L from w and back.
  void (*momentum_of)(const Bodies&, const double* state, double* carried);
  void (*velocity_of)(const Bodies&, double* state, const double* carried);
  // v += h F/m, L += h tau.
  void (*momentum_kick)(const Bodies&, double* state, double* carried, const double* wrench, double h);
  // x += h v, and the rotation of free_rotation.h over h with constant L.
  void (*free_drift)(const Bodies&, double* state, const double* carried, double h);
  // The same with the rotation of moser_veselov.cpp; false if its equation had no solution for some body.
  bool (*moser_veselov_drift)(const Bodies&, double* state, const double* carried, double dt);
  // One stage of a Runge–Kutta method in which each stage needs only the rates of the previous one. Adds weight * rates
  // to the sum and continues at start + next * rates; both in s. For quaternions, or for rotation vectors
  // (classical_runge_kutta.h).
  void (*quaternion_stage)(const Bodies&, const StageTables&, const double* wrench, Stage, double weight, double next);
  void (*rotation_vector_stage)(const Bodies&, const StageTables&, const double* wrench, Stage, double weight,
                                double next);
  // For methods that keep the rates of several stages. y is a table of x, orientation of any length, v, L.
  // motion_of: the motion of y. rates_at: the rates of y at a motion.
  // combine: out = y + h times the weighted sum of rates, or only that sum if y is null.
  // relative_size: the sum of |dx|/(1 m + |x|), |dv|/(1 m/s + |v|), |dw|/(1 rad/s + |w|) and the angle [rad], largest
  // over the bodies. dw is the change of w by the change of L.
  void (*motion_of)(const Bodies&, const double* y, std::size_t stride_of_y, double* state);
  void (*rates_at)(const Bodies&, const double* state, const double* wrench, double* rates);
  void (*combine)(const Bodies&, const double* y, double h, const double* weights, const double* const* rates,
                  std::size_t count, double* out);
  double (*relative_size)(const Bodies&, const double* change, const double* y);
  // The two halves of a step of an Adams method. Before the loads, for doubles `first` to `last` of the tables: the
  // sums of known rates for the step after this. After the loads: corrects y by the rates at the stage, writes them to
  // `rates`, and predicts the stage of the next step. v and w are computed only if it `needs_w`. Positions use the
  // velocities of the same instant.
  void (*sums_of_older)(std::size_t first, std::size_t last, const AdamsRates&, const AdamsTables&);
  void (*adams_advance)(const Bodies&, const AdamsTables&, const AdamsWeights&, const double* wrench, double* rates,
                        AdamsRatesFrom from, bool needs_w);
  void (*springs)(const Springs&, const double* state, std::size_t stride, double* pulls);
  // Whether no sphere is farther from where it was found than slack[axis] along any axis.
  bool (*have_stayed)(const Bodies&, const double* state, const double* spheres, const double* slack);
  // Writes the spheres that overlap a plane {normal, offset} to `rows`, which has room for all, and returns their
  // count.
  std::size_t (*below_plane)(const Bodies&, const double* state, const double* spheres, const double* plane,
                             std::int32_t* rows);
  // Between the state and records by body: v, w there and back; inverse inertias in W, xx, yy, zz, xy, xz, yz
  // [1/(kg m²)] and the inverse mass [1/kg].
  void (*gather_velocities)(const Bodies&, const double* state, double* velocities);
  void (*scatter_velocities)(const Bodies&, const double* velocities, double* state);
  void (*gather_inverse_inertias)(const Bodies&, const double* state, double* inverse_inertias);
};

// The table in use.
const Kernels& kernels();

// For tests and benchmarks: every table that this processor supports, the plain one first. KernelsInPlace puts one to
// use during its lifetime. Not for worlds in other threads.
inline constexpr std::size_t kMostKernelTables = 3;
std::size_t available_kernels(const Kernels* (&out)[kMostKernelTables]);
class KernelsInPlace {
 public:
  explicit KernelsInPlace(const Kernels& table);
  ~KernelsInPlace();
  KernelsInPlace(const KernelsInPlace&) = delete;
  KernelsInPlace& operator=(const KernelsInPlace&) = delete;

 private:
  const Kernels* before_;
};

}  // namespace rigor::inline dynamics
