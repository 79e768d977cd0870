// What the contact kernels work on (contact/impulse/impulse.cpp is the method): rows, each a contact constraint of two
// bodies, eight to a block, and records of eight doubles a body, so that a row finds a body in one cache line. The rows
// of a block share no moving body.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rigor {

inline constexpr std::size_t kRowsPerBlock = 8, kRecord = 8;

// `a` and `b` are the two bodies; the normal points from b to a. Vectors in W.
enum RowColumn {
  kNormal = 0,
  kTangent = 3,  // one of two
  kArmA = 6,     // m, from the centre of mass to a's point
  kArmB = 9,
  kAngularA = 12,      // I⁻¹ (arm x d), what unit impulses along d = normal and the two tangents add to w; before
                       // prepare_rows() the first holds the impulse of friction, in W
  kAngularB = 21,      // and take from it
  kInverseMassA = 30,  // 1/kg
  kInverseMassB = 31,
  kNormalMass = 32,   // kg, effective mass along the normal
  kTangentMass = 33,  // kg: tt, ss, ts of the inverse of the tangential inverse effective mass K_t
  kSlipMass = 36,     // kg, 1 / the larger eigenvalue of K_t
  kFriction = 37,
  kRestitution = 38,
  kInitialGap = 39,     // m, when contacts were last updated
  kGap = 40,            // m, before the sub-step
  kApproachSpeed = 41,  // m/s, before the sub-step
  kBias = 42,           // m/s
  kImpulse = 43,        // N s of one sub-step: along the normal, the two tangents
  kRowColumns = 46
};

struct alignas(64) RowBlock {
  double columns[kRowColumns][kRowsPerBlock];
  std::int32_t a[kRowsPerBlock], b[kRowsPerBlock];        // whose records are read
  std::int32_t to_a[kRowsPerBlock], to_b[kRowsPerBlock];  // and written: those of fixed bodies are not
};

// Records by body, and after them two idle ones: rows that fill a block read the first, of a body at rest, and write
// the second.
struct SolverBodies {
  double* velocities;              // v, w
  double* displacements;           // m and rad since contacts were last updated
  std::int32_t* last_active;       // the last sweep over the impacts in which one changed it
  const double* inverse_inertias;  // in W, xx, yy, zz, xy, xz, yz, 1/(kg m²), when contacts were updated; 1/kg
};

struct SolverParameters {
  double h;                                     // s, of a sub-step
  double theta;                                 // x' = x + h (theta u' + (1 - theta) u) over a sub-step
  double bias_rate, mass_scale, impulse_scale;  // of the soft constraint: 1/s, 1, 1
  double max_push_speed;                        // m/s, at which overlapping bodies are pushed apart
  double restitution_threshold;                 // m/s: a slower approach is no impact
  double tolerance;                             // m/s: impacts are solved until they change by less, in at most
  int max_sweeps;                               // so many sweeps
};

}  // namespace rigor
