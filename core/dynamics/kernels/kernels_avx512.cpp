// Eight lanes, for processors with AVX-512.
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
#pragma clang attribute push(__attribute__((target("avx512f,avx512dq,avx512vl"))), apply_to = function)
#else
#pragma GCC target("avx512f,avx512dq,avx512vl")
#endif
#define RIGOR_LANES 8
#define RIGOR_LANES_OF avx512
#define RIGOR_LANES_NAME "AVX-512"
#include "core/dynamics/kernels/all-inl.h"
#ifdef __clang__
#pragma clang attribute pop
#endif
#endif
