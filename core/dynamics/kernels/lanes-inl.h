// The lanes of one instruction set: `Lane`, kWidth doubles that a vector register holds, beside the plain double, with
// what C++'s operators do not give. Included once by each kernels_*.cpp, which names the instruction set; on purpose
// without a guard.

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
// Rows to columns, of as many registers as each has lanes.
RIGOR_INLINE void transpose(Lane* r) {
  Lane even[4], odd[4];
  for (int k = 0; k < 4; ++k) {
    even[k] = __builtin_shufflevector(r[2 * k], r[2 * k + 1], 0, 8, 2, 10, 4, 12, 6, 14);
    odd[k] = __builtin_shufflevector(r[2 * k], r[2 * k + 1], 1, 9, 3, 11, 5, 13, 7, 15);
  }
  const auto spread = [r](const Lane(&pairs)[4], int column) RIGOR_LAMBDA {
    const Lane low04 = __builtin_shufflevector(pairs[0], pairs[1], 0, 1, 4, 5, 8, 9, 12, 13);
    const Lane low26 = __builtin_shufflevector(pairs[0], pairs[1], 2, 3, 6, 7, 10, 11, 14, 15);
    const Lane high04 = __builtin_shufflevector(pairs[2], pairs[3], 0, 1, 4, 5, 8, 9, 12, 13);
    const Lane high26 = __builtin_shufflevector(pairs[2], pairs[3], 2, 3, 6, 7, 10, 11, 14, 15);
    r[column] = __builtin_shufflevector(low04, high04, 0, 1, 4, 5, 8, 9, 12, 13);
    r[column + 2] = __builtin_shufflevector(low26, high26, 0, 1, 4, 5, 8, 9, 12, 13);
    r[column + 4] = __builtin_shufflevector(low04, high04, 2, 3, 6, 7, 10, 11, 14, 15);
    r[column + 6] = __builtin_shufflevector(low26, high26, 2, 3, 6, 7, 10, 11, 14, 15);
  };
  spread(even, 0), spread(odd, 1);
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
RIGOR_INLINE void transpose(Lane* r) {
  const Lane even01 = __builtin_shufflevector(r[0], r[1], 0, 4, 2, 6),
             odd01 = __builtin_shufflevector(r[0], r[1], 1, 5, 3, 7);
  const Lane even23 = __builtin_shufflevector(r[2], r[3], 0, 4, 2, 6),
             odd23 = __builtin_shufflevector(r[2], r[3], 1, 5, 3, 7);
  r[0] = __builtin_shufflevector(even01, even23, 0, 1, 4, 5), r[1] = __builtin_shufflevector(odd01, odd23, 0, 1, 4, 5);
  r[2] = __builtin_shufflevector(even01, even23, 2, 3, 6, 7), r[3] = __builtin_shufflevector(odd01, odd23, 2, 3, 6, 7);
}
#else
// Two doubles: what every x86-64 and ARM64 has; the compiler makes of it what the machine can.
using Lane = double __attribute__((vector_size(16)));
RIGOR_INLINE Lane broadcast(Lane, double x) { return Lane{x, x}; }
RIGOR_INLINE Lane load(Lane, const double* p) { return Lane{p[0], p[1]}; }
RIGOR_INLINE void store(double* p, Lane x) { p[0] = x[0], p[1] = x[1]; }
RIGOR_INLINE Lane square_root(Lane x) { return Lane{__builtin_sqrt(x[0]), __builtin_sqrt(x[1])}; }
RIGOR_INLINE bool all_at_most(Lane x, double limit) { return x[0] <= limit && x[1] <= limit; }
RIGOR_INLINE Lane if_at_most(Lane x, Lane limit, Lane yes, Lane no) {
  return Lane{x[0] <= limit[0] ? yes[0] : no[0], x[1] <= limit[1] ? yes[1] : no[1]};
}
RIGOR_INLINE Lane gather(Lane, const double* p, const std::int32_t* i) { return Lane{p[i[0]], p[i[1]]}; }
RIGOR_INLINE void transpose(Lane* r) {
  const Lane low = r[0], high = r[1];
  r[0] = Lane{low[0], high[0]}, r[1] = Lane{low[1], high[1]};
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
RIGOR_INLINE void transpose(double*) {}

constexpr std::size_t width_of(double) { return 1; }
constexpr std::size_t width_of(Lane) { return kWidth; }

// Calls f(T(), row) for the rows begin, begin + 1, … or, kWidth at once, begin, begin + kWidth, …: a few rows take one
// at a time, for the sake of the other code that reads and writes single rows right before and after.
template <class F>
RIGOR_INLINE void for_rows(std::size_t begin, std::size_t end, F f, std::size_t few = kFewBodies) {
  if (end - begin <= few) {
    for (std::size_t i = begin; i < end; ++i) f(double(), i);
    return;
  }
  for (std::size_t i = begin; i < end; i += kWidth) f(Lane(), i);
}
