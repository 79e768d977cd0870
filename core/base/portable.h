// Elementary functions with the same bits on every processor, compiler and C library. A C library has several versions
// of its own and takes one by the processor, and those with fused multiply-add round otherwise. These are made of IEEE
// sums, products, quotients and roots alone. Exact to one and a half units in the last place.
#pragma once

namespace rigor::portable {

// Of an angle [rad]. An angle beyond 1e15 is taken modulo the double next to 2 pi, so the result is that of another
// angle.
double sin(double x);
double cos(double x);
// The angle [rad] of the point (x, y), from -pi to pi, with the signs of zeros and infinities as in C.
double atan2(double y, double x);
double exp(double x);

}  // namespace rigor::portable
