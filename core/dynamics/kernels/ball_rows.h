// What the kernels of ball joints work on (joints/ball_joints.h is the method): joints and couplings, which are two
// joints on one body, in blocks of eight rows, and records of eight doubles a body (contact_rows.h). Vectors in W. Rows
// that fill a block are of the world alone, whose record comes after the bodies'.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rigor {

enum PoseRecord { kPosePosition = 0, kPoseOrientation = 3 };

enum BallColumn {
  kPinA = 0,  // m, of the joint in each end's frame
  kPinB = 3,
  kArmOfA = 6,  // m, the same in W, at the start of a step
  kArmOfB = 9,
  kRightSide = 12,  // m/s: of the equations for the impulse
  kReach = 15,      // m, from a's centre to b's where the joint is closed
  kDiagonal = 18,   // 1/kg: the block of the Delassus matrix, xx, yy, zz, xy, xz, yz,
  kScale = 24,      // and the product of the first three
  kBallColumns = 25
};
enum CouplingColumn {
  kBlock = 0,  // 1/kg: of the row's joint and the column's, column by column
  kSign = 9,   // 1 if the body is at the same end of both, -1 if not, 0 if there is none
  kCouplingColumns = 10
};

// Column 0 of a row; column c is 8 c further on.
inline std::size_t start_of_row(std::size_t row, int columns) { return (row & ~std::size_t{7}) * columns + (row & 7); }

struct BallRows {
  std::size_t joints, couplings;
  double* by_joint;           // BallColumn
  double* by_coupling;        // CouplingColumn
  const std::int32_t *a, *b;  // records of the joints' bodies
  // Of a coupling: its body's record, and where in by_joint the arms of both joints stand.
  const std::int32_t *body, *row_arm, *column_arm;
  const double* inverse_inertias;  // records as SolverBodies has them
};

}  // namespace rigor
