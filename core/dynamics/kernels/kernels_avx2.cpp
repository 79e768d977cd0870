// Four lanes, for processors with AVX2.
#ifdef __x86_64__
#include <immintrin.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/base/portable.h"
#include "core/base/sine_polynomials.h"
#include "core/dynamics/kernels/ball_kernels.h"
#include "core/dynamics/kernels/contact_kernels.h"

#ifdef __clang__
#pragma clang attribute push(__attribute__((target("avx2"))), apply_to = function)
#else
#pragma GCC target("avx2")
#endif
#define RIGOR_LANES 4
#define RIGOR_LANES_OF avx2
#define RIGOR_LANES_NAME "AVX2"
#include "core/dynamics/kernels/all-inl.h"
#ifdef __clang__
#pragma clang attribute pop
#endif
#endif
