// The lanes of one instruction set: `Lane` holds kWidth doubles in a vector register. The same functions exist for a
// plain double. They add operations that C++'s operators lack. Each kernels_*.cpp, which names the instruction set,
// includes this file once; it has no guard on purpose.

#if RIGOR_LANES == 8
using Lane = __m512d;
RIGOR_INLINE Lane broadcast(Lane, double x) { return _mm512_set1_pd(x); }
RIGOR_INLINE Lane load(Lane, const double* p) { return _mm512_loadu_pd(p); }
RIGOR_INLINE void store(double* p, Lane x) { _mm512_storeu_pd(p, x); }
RIGOR_INLINE Lane square_root(Lane x) { return _mm512_maskz_sqrt_pd(0xff, x); }
RIGOR_INLINE bool all_at_most(Lane x, double limit) {
  return _mm512_cmp_pd_mask(x, _mm512_set1_pd(limit), _CMP_LE_OQ) == 0xff;
}
RIGOR_INLINE Lane if_at_most(Lane x, Lane limit, Lane yes, Lane no) {
  return _mm512_mask_blend_pd(_mm512_cmp_pd_mask(x, limit, _CMP_LE_OQ), no, yes);
}
RIGOR_INLINE Lane gather(Lane, const double* p, const std::int32_t* i) {
  return Lane{p[i[0]], p[i[1]], p[i[2]], p[i[3]], p[i[4]], p[i[5]], p[i[6]], p[i[7]]};
}
// Two columns, side by side in rows, of which `row` gives the k-th.
template <class F>
RIGOR_INLINE void load_two(F row, Lane& first, Lane& second) {
  const auto every_other = [&](std::size_t k) RIGOR_LAMBDA {
    Lane x = _mm512_zextpd128_pd512(_mm_loadu_pd(row(k)));
    x = _mm512_insertf64x2(x, _mm_loadu_pd(row(k + 2)), 1);
    x = _mm512_insertf64x2(x, _mm_loadu_pd(row(k + 4)), 2);
    return _mm512_insertf64x2(x, _mm_loadu_pd(row(k + 6)), 3);
  };
  const Lane even = every_other(0), odd = every_other(1);
  first = __builtin_shufflevector(even, odd, 0, 8, 2, 10, 4, 12, 6, 14);
  second = __builtin_shufflevector(even, odd, 1, 9, 3, 11, 5, 13, 7, 15);
}
template <class F>
RIGOR_INLINE void store_two(F row, Lane first, Lane second) {
  const auto every_other = [&](std::size_t k, Lane x) RIGOR_LAMBDA {
    _mm_storeu_pd(row(k), __builtin_shufflevector(x, x, 0, 1));
    _mm_storeu_pd(row(k + 2), _mm512_maskz_extractf64x2_pd(0xff, x, 1));
    _mm_storeu_pd(row(k + 4), _mm512_maskz_extractf64x2_pd(0xff, x, 2));
    _mm_storeu_pd(row(k + 6), _mm512_maskz_extractf64x2_pd(0xff, x, 3));
  };
  every_other(0, __builtin_shufflevector(first, second, 0, 8, 2, 10, 4, 12, 6, 14));
  every_other(1, __builtin_shufflevector(first, second, 1, 9, 3, 11, 5, 13, 7, 15));
}
#elif RIGOR_LANES == 4
using Lane = __m256d;
RIGOR_INLINE Lane broadcast(Lane, double x) { return _mm256_set1_pd(x); }
RIGOR_INLINE Lane load(Lane, const double* p) { return _mm256_loadu_pd(p); }
RIGOR_INLINE void store(double* p, Lane x) { _mm256_storeu_pd(p, x); }
RIGOR_INLINE Lane square_root(Lane x) { return _mm256_sqrt_pd(x); }
RIGOR_INLINE bool all_at_most(Lane x, double limit) {
  return _mm256_movemask_pd(_mm256_cmp_pd(x, _mm256_set1_pd(limit), _CMP_LE_OQ)) == 0xf;
}
RIGOR_INLINE Lane if_at_most(Lane x, Lane limit, Lane yes, Lane no) {
  return _mm256_blendv_pd(no, yes, _mm256_cmp_pd(x, limit, _CMP_LE_OQ));
}
RIGOR_INLINE Lane gather(Lane, const double* p, const std::int32_t* i) {
  return Lane{p[i[0]], p[i[1]], p[i[2]], p[i[3]]};
}
template <class F>
RIGOR_INLINE void load_two(F row, Lane& first, Lane& second) {
  const auto every_other = [&](std::size_t k) RIGOR_LAMBDA {
    return _mm256_insertf128_pd(_mm256_zextpd128_pd256(_mm_loadu_pd(row(k))), _mm_loadu_pd(row(k + 2)), 1);
  };
  const Lane even = every_other(0), odd = every_other(1);
  first = __builtin_shufflevector(even, odd, 0, 4, 2, 6);
  second = __builtin_shufflevector(even, odd, 1, 5, 3, 7);
}
template <class F>
RIGOR_INLINE void store_two(F row, Lane first, Lane second) {
  const auto every_other = [&](std::size_t k, Lane x) RIGOR_LAMBDA {
    _mm_storeu_pd(row(k), _mm256_castpd256_pd128(x));
    _mm_storeu_pd(row(k + 2), _mm256_extractf128_pd(x, 1));
  };
  every_other(0, __builtin_shufflevector(first, second, 0, 4, 2, 6));
  every_other(1, __builtin_shufflevector(first, second, 1, 5, 3, 7));
}
#else
// Two doubles, as on every x86-64 and ARM64, and in WebAssembly with SIMD; the compiler chooses the instructions.
using Lane = double __attribute__((vector_size(16)));
RIGOR_INLINE Lane broadcast(Lane, double x) { return Lane{x, x}; }
RIGOR_INLINE Lane load(Lane, const double* p) { return Lane{p[0], p[1]}; }
RIGOR_INLINE void store(double* p, Lane x) { p[0] = x[0], p[1] = x[1]; }
#ifdef __wasm_simd128__
RIGOR_INLINE Lane square_root(Lane x) { return (Lane)wasm_f64x2_sqrt((v128_t)x); }
RIGOR_INLINE bool all_at_most(Lane x, double limit) {
  return wasm_i64x2_all_true(wasm_f64x2_le((v128_t)x, wasm_f64x2_splat(limit)));
}
RIGOR_INLINE Lane if_at_most(Lane x, Lane limit, Lane yes, Lane no) {
  return (Lane)wasm_v128_bitselect((v128_t)yes, (v128_t)no, wasm_f64x2_le((v128_t)x, (v128_t)limit));
}
#else
RIGOR_INLINE Lane square_root(Lane x) { return Lane{__builtin_sqrt(x[0]), __builtin_sqrt(x[1])}; }
RIGOR_INLINE bool all_at_most(Lane x, double limit) { return x[0] <= limit && x[1] <= limit; }
RIGOR_INLINE Lane if_at_most(Lane x, Lane limit, Lane yes, Lane no) {
  return Lane{x[0] <= limit[0] ? yes[0] : no[0], x[1] <= limit[1] ? yes[1] : no[1]};
}
#endif
RIGOR_INLINE Lane gather(Lane, const double* p, const std::int32_t* i) { return Lane{p[i[0]], p[i[1]]}; }
template <class F>
RIGOR_INLINE void load_two(F row, Lane& first, Lane& second) {
#ifdef __wasm_simd128__  // or the compiler loads each number alone
  const v128_t even = wasm_v128_load(row(0)), odd = wasm_v128_load(row(1));
  first = (Lane)wasm_i64x2_shuffle(even, odd, 0, 2), second = (Lane)wasm_i64x2_shuffle(even, odd, 1, 3);
#else
  const Lane even = load(Lane(), row(0)), odd = load(Lane(), row(1));
  first = Lane{even[0], odd[0]}, second = Lane{even[1], odd[1]};
#endif
}
template <class F>
RIGOR_INLINE void store_two(F row, Lane first, Lane second) {
  store(row(0), Lane{first[0], second[0]}), store(row(1), Lane{first[1], second[1]});
}
#endif
inline constexpr std::size_t kWidth = sizeof(Lane) / sizeof(double);

RIGOR_INLINE double broadcast(double, double x) { return x; }
RIGOR_INLINE double load(double, const double* p) { return *p; }
RIGOR_INLINE void store(double* p, double x) { *p = x; }
RIGOR_INLINE double square_root(double x) { return __builtin_sqrt(x); }
RIGOR_INLINE bool all_at_most(double x, double limit) { return x <= limit; }
RIGOR_INLINE double if_at_most(double x, double limit, double yes, double no) { return x <= limit ? yes : no; }
RIGOR_INLINE double gather(double, const double* p, const std::int32_t* i) { return p[i[0]]; }
template <class F>
RIGOR_INLINE void load_two(F row, double& first, double& second) {
  first = row(0)[0], second = row(0)[1];
}
template <class F>
RIGOR_INLINE void store_two(F row, double first, double second) {
  row(0)[0] = first, row(0)[1] = second;
}

constexpr std::size_t width_of(double) { return 1; }
constexpr std::size_t width_of(Lane) { return kWidth; }

// Calls f(T(), row) for the rows begin, begin + 1, … or, kWidth at once, begin, begin + kWidth, …. A few rows are
// processed one at a time, because neighbouring code reads and writes single rows.
template <class F>
RIGOR_INLINE void for_rows(std::size_t begin, std::size_t end, F f, std::size_t few = kFewBodies) {
  if (end - begin <= few) {
    for (std::size_t i = begin; i < end; ++i) f(double(), i);
    return;
  }
  for (std::size_t i = begin; i < end; i += kWidth) f(Lane(), i);
}
