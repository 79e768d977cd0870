// What the kernels of piles work on (contact/pile_solver.h): rows, of which each is a point of two bodies, eight to a
// block, and records of eight doubles a body, so that a row finds a body in one cache line. The rows of a block share
// no body that moves.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rigor {

inline constexpr std::size_t kRowsPerBlock = 8, kRecord = 8;

// `a` and `b` are the two bodies; the normal points from b to a. Vectors in W.
enum RowColumn {
  kNormal = 0,
  kTangent = 3,  // one of two
  kArmA = 6,     // m, from the centre of mass to the point of a
  kArmB = 9,
  kSpinA = 12,         // what unit impulses along the normal and the two tangents add to w; until then first the
                       // impulse of friction, in W
  kSpinB = 21,         // and take from it
  kInverseMassA = 30,  // 1/kg
  kInverseMassB = 31,
  kPaceNormal = 32,  // kg, 1 / what a unit impulse gives
  kPaceStick = 33,   // kg: tt, ss, ts of the inverse of the tangential give
  kPaceSlip = 36,    // kg, 1 / the larger eigenvalue of that give
  kFriction = 37,
  kRestitution = 38,
  kGap = 39,       // m, at the stretch's start
  kGapNow = 40,    // m, before the sub-step
  kApproach = 41,  // m/s, before the sub-step
  kBias = 42,      // m/s
  kImpulse = 43,   // N s of one sub-step: along the normal, the two tangents
  kRowColumns = 46
};

struct alignas(64) RowBlock {
  double columns[kRowColumns][kRowsPerBlock];
  std::int32_t a[kRowsPerBlock], b[kRowsPerBlock];        // whose records are read
  std::int32_t to_a[kRowsPerBlock], to_b[kRowsPerBlock];  // and written: those of bodies that do not move are not
};

// Records by body, and after them two that mean nothing: rows that fill a block read the first, of a body at rest, and
// write the second.
struct PileRecords {
  double* motions;         // v, w
  double* changes;         // m and rad since the stretch's start
  std::int32_t* stirred;   // the last turn over the hits in which one changed it
  const double* inertias;  // the inverse inertia in W, xx, yy, zz, xy, xz, yz, 1/(kg m²), at its start; 1/kg
};

struct PileLaw {
  double h;                                     // s, of a sub-step
  double share;                                 // see PileSolver
  double push_rate, mass_share, impulse_share;  // of the spring and damper that push overlapping bodies apart
  double fastest_push;                          // m/s
  double rest_speed;                            // m/s: points that come together slower do not hit
  double settled;                               // m/s: hits are solved until they change by less, but at most
  int most_turns;                               // so many times over
};

}  // namespace rigor
