// The data of the kernels for ball joints and hinges; joints/ball_joints.h describes the method. Pins, and couplings
// (two pins on one body), are stored in blocks of eight rows. Records hold eight doubles per body (contact_rows.h). A
// pin holds two points together; the second pin of a hinge leaves the direction along its axis free. Vectors are in W.
// Rows that fill up a block belong to the world alone, whose record follows the bodies'.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rigor::inline dynamics {

enum PoseRecord { kPosePosition = 0, kPoseOrientation = 3 };

enum BallColumn {
  kPinA = 0,  // m, of the pin in each end's frame
  kPinB = 3,
  kArmOfA = 6,  // m, the same in W, at the start of a step
  kArmOfB = 9,
  kRightSide = 12,  // m/s: of the equations for the impulse
  kReach = 15,      // m, from a's centre to b's where the pin is closed
  kDiagonal = 18,   // 1/kg: the block of the Delassus matrix, xx, yy, zz, xy, xz, yz,
  kScale = 24,      // and the product of the first three
  kAxisInA = 25,    // along which the pin is free, in a's frame; zero if along none
  kAxis = 28,       // the same in W, at the start of a step
  kBallColumns = 31
};
enum CouplingColumn {
  kBlock = 0,  // 1/kg: of the row's pin and the column's, column by column
  kSign = 9,   // 1 if the body is at the same end of both, -1 if not, 0 without a body
  kCouplingColumns = 10
};

// Column 0 of a row; column c is 8 c further on.
inline std::size_t start_of_row(std::size_t row, int columns) { return (row & ~std::size_t{7}) * columns + (row & 7); }

// Couplings by the body that both pins are on.
struct BallCouplings {
  std::size_t size;
  double* blocks;  // CouplingColumn
  // The body's record, and where among the pins' columns the arms of both, and their axes, stand.
  const std::int32_t *body, *row_arm, *column_arm, *row_axis, *column_axis;
};

struct BallRows {
  std::size_t pins;
  bool has_axes;
  double* by_pin;              // BallColumn
  const std::int32_t *a, *b;   // records of the pins' bodies
  BallCouplings first, other;  // other: by the second body of two pins that hold the same two, to be added to the first
  const double* inverse_inertias;  // records as SolverBodies has them
};

}  // namespace rigor::inline dynamics
