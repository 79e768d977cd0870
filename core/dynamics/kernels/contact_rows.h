// The data of the contact kernels; contact/impulse/impulse.cpp describes the method. A row is a contact constraint of
// two bodies. Records hold eight doubles per body, so that a row finds a body in one cache line. Eight pairs of bodies
// that share no moving body form a group. A group has one block of eight rows, one per pair, for each contact point of
// the pair with the most points.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rigor::inline dynamics {

inline constexpr std::size_t kRowsPerBlock = 8;

// `a` and `b` are the two bodies; the normal points from b to a. Vectors in W. Column c of a block begins at its double
// c * kRowsPerBlock.
enum RowColumn {
  kNormal = 0,
  kInverseMassA = 3,  // 1/kg
  kInverseMassB = 4,
  kNormalMass = 5,  // kg, effective mass along the normal
  kFriction = 6,
  kRestitution = 7,
  kInitialGap = 8,      // m, when contacts were last updated
  kGap = 9,             // m, before the sub-step
  kApproachSpeed = 10,  // m/s, before the sub-step
  kBias = 11,           // m/s
  kImpulse = 12,        // N s of one sub-step, along the normal
  // Before prepare_rows(), and after it only in rows of balls: the impulse of friction, in W.
  kFrictionImpulse = 13,

  // For any two bodies.
  kTangentImpulse = 13,  // N s of one sub-step, along the two tangents
  kTangent = 15,         // one of two
  kArmA = 18,            // m, from the centre of mass to a's point
  kArmB = 21,
  kTangentMass = 24,  // kg: tt, ss, ts of the inverse of the tangential inverse effective mass K_t
  kSlipMass = 27,     // kg, 1 / the larger eigenvalue of K_t
  kColumnsOfAny = 28,

  // For two balls or fixed bodies: their arms lie along the normal, -l_a n and l_b n, and inertias are numbers I.
  // Tangents are not needed.
  kLengthA = 16,  // m, l_a
  kLengthB = 17,
  kTurnA = 18,  // l_a / I_a, 1/(kg m)
  kTurnB = 19,
  kAcrossMass = 20,  // kg, effective mass across the normal
  kColumnsOfBalls = 21
};

struct alignas(64) RowGroup {
  std::int32_t a[kRowsPerBlock], b[kRowsPerBlock];        // whose records are read
  std::int32_t to_a[kRowsPerBlock], to_b[kRowsPerBlock];  // and written: those of fixed bodies are not
  double* rows;                                           // blocks, one after another
  std::int32_t points;                                    // so many
  std::int32_t colour;                                    // groups of one share no moving body
  bool of_balls;                                          // which of the two kinds

  std::size_t columns() const { return of_balls ? kColumnsOfBalls : kColumnsOfAny; }
  double* block(std::size_t point) const { return rows + point * columns() * kRowsPerBlock; }
};

// One of the rows.
struct RowPlace {
  std::int32_t group;
  std::int16_t point, lane;
};

// Eight contacts of two balls each, a from b.
struct alignas(64) BallContacts {
  double normal[3][kRowsPerBlock];  // unit, from b to a
  double gap[kRowsPerBlock];        // m
  double overlap[kRowsPerBlock];    // m: 0 or less; for a later contact, its remaining gap at that instant
  double excess[kRowsPerBlock];     // m, of the gap over the kept distance
};

// Records by body, followed by idle records. Rows without a constraint read the first of these, of a body at rest, and
// write one of the others; each thread has its own.
struct SolverBodies {
  double* velocities;              // v, w
  double* displacements;           // m and rad since contacts were last updated
  const double* inverse_inertias;  // and inverse masses, when contacts were updated
};

struct SolverParameters {
  double h;                                     // s, of a sub-step
  double theta;                                 // x' = x + h (theta u' + (1 - theta) u) over a sub-step
  double bias_rate, mass_scale, impulse_scale;  // of the soft constraint: 1/s, 1, 1
  double max_push_speed;                        // m/s, at which overlapping bodies are pushed apart
  double touching;                              // m: a point with no larger gap is a soft constraint
  double restitution_threshold;                 // m/s: a slower approach is no impact
  double tolerance;                             // m/s: impacts are solved until they change by less, in at most
  int max_sweeps;                               // so many sweeps
};

}  // namespace rigor::inline dynamics
