// Two lanes, for every machine.
#ifdef __wasm_simd128__
#include <wasm_simd128.h>
#endif

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/base/portable.h"
#include "core/base/sine_polynomials.h"
#include "core/dynamics/kernels/ball_kernels.h"
#include "core/dynamics/kernels/contact_kernels.h"

#define RIGOR_LANES 2
#define RIGOR_LANES_OF plain
#ifdef __wasm_simd128__
#define RIGOR_LANES_NAME "WebAssembly SIMD"
#else
#define RIGOR_LANES_NAME "plain"
#endif
#include "core/dynamics/kernels/all-inl.h"
