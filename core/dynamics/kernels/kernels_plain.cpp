// Two lanes, for every machine.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/base/portable.h"
#include "core/base/sine_polynomials.h"
#include "core/dynamics/kernels/ball_kernels.h"
#include "core/dynamics/kernels/contact_kernels.h"

#define RIGOR_LANES 2
#define RIGOR_LANES_OF plain
#define RIGOR_LANES_NAME "plain"
#include "core/dynamics/kernels/all-inl.h"
