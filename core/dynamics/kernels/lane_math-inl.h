// Vectors, matrices, quaternions and inertias whose components are lanes; core/base/math.h in other words. Included
// once by each kernels_*.cpp, on purpose without a guard.

template <class T>
struct V3 {
  T x, y, z;
};
template <class T>
struct Q4 {
  T w, x, y, z;
};
template <class T>
struct M3 {
  V3<T> x, y, z;  // rows
};
template <class T>
struct Symmetric {
  T xx, yy, zz, xy, xz, yz;
};

template <class T>
RIGOR_INLINE V3<T> operator+(V3<T> a, V3<T> b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
RIGOR_INLINE V3<T> operator-(V3<T> a, V3<T> b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
RIGOR_INLINE V3<T> operator*(T s, V3<T> a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
RIGOR_INLINE T dot(V3<T> a, V3<T> b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class T>
RIGOR_INLINE V3<T> cross(V3<T> a, V3<T> b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T>
RIGOR_INLINE V3<T> times_each(V3<T> a, V3<T> b) {
  return {a.x * b.x, a.y * b.y, a.z * b.z};
}
template <class T>
RIGOR_INLINE V3<T> operator*(const M3<T>& m, V3<T> a) {
  return {dot(m.x, a), dot(m.y, a), dot(m.z, a)};
}
template <class T>
RIGOR_INLINE V3<T> transposed_times(const M3<T>& m, V3<T> a) {
  return {m.x.x * a.x + m.y.x * a.y + m.z.x * a.z, m.x.y * a.x + m.y.y * a.y + m.z.y * a.z,
          m.x.z * a.x + m.y.z * a.y + m.z.z * a.z};
}
template <class T>
RIGOR_INLINE V3<T> operator*(const Symmetric<T>& m, V3<T> a) {
  return {m.xx * a.x + m.xy * a.y + m.xz * a.z, m.xy * a.x + m.yy * a.y + m.yz * a.z,
          m.xz * a.x + m.yz * a.y + m.zz * a.z};
}

template <class T>
RIGOR_INLINE Q4<T> operator*(Q4<T> a, Q4<T> b) {
  return {a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
          a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}
// (0, v) q
template <class T>
RIGOR_INLINE Q4<T> operator*(V3<T> v, Q4<T> q) {
  return {T{} - (v.x * q.x + v.y * q.y + v.z * q.z), v.x * q.w + v.y * q.z - v.z * q.y,
          v.y * q.w + v.z * q.x - v.x * q.z, v.z * q.w + v.x * q.y - v.y * q.x};
}
template <class T>
RIGOR_INLINE Q4<T> operator+(Q4<T> a, Q4<T> b) {
  return {a.w + b.w, a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
RIGOR_INLINE Q4<T> operator*(T s, Q4<T> q) {
  return {s * q.w, s * q.x, s * q.y, s * q.z};
}
template <class T>
RIGOR_INLINE T squared_norm(Q4<T> q) {
  return (q.w * q.w + q.x * q.x) + (q.y * q.y + q.z * q.z);
}
template <class T>
RIGOR_INLINE Q4<T> normalised(Q4<T> q) {
  return (broadcast(T(), 1) / square_root(squared_norm(q))) * q;
}
// Of a product of unit quaternions: with |q|² = 1 + e the factor (3 - |q|²)/2 leaves 3/8 e², below rounding for an e of
// some roundings; a q that was not of unit length comes closer with each step.
template <class T>
RIGOR_INLINE Q4<T> nearly_unit_normalised(Q4<T> q) {
  return (broadcast(T(), 1.5) - broadcast(T(), 0.5) * squared_norm(q)) * q;
}

// B to W.
template <class T>
RIGOR_INLINE M3<T> matrix_of(Q4<T> q) {
  const T ww = q.w * q.w, xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z;
  const T x2 = q.x + q.x, y2 = q.y + q.y, z2 = q.z + q.z;
  const T xy = x2 * q.y, xz = x2 * q.z, yz = y2 * q.z, wx = x2 * q.w, wy = y2 * q.w, wz = z2 * q.w;
  const T p = ww - zz, m = xx - yy;
  return {{p + m, xy - wz, xz + wy}, {xy + wz, p - m, yz - wx}, {xz - wy, yz + wx, (ww + zz) - (xx + yy)}};
}
template <class T>
RIGOR_INLINE V3<T> rotated(Q4<T> q, V3<T> a) {
  const V3<T> u = {q.x, q.y, q.z}, c = cross(u, a), t = c + c;
  return a + q.w * t + cross(u, t);
}

template <class T>
RIGOR_INLINE T polynomial7(T s, const double (&c)[8]) {
  const auto pair = [&](int k) RIGOR_LAMBDA { return broadcast(T(), c[k]) + broadcast(T(), c[k + 1]) * s; };
  const T s2 = s * s, s4 = s2 * s2;
  return (pair(0) + pair(2) * s2) + (pair(4) + pair(6) * s2) * s4;
}

// Lane by lane for turns of more than half a revolution.
template <class T>
__attribute__((noinline)) void large_cosine_and_quotient(const T& s, T& cosine, T& quotient) {
  double in[sizeof(T) / sizeof(double)], c[sizeof(T) / sizeof(double)], f[sizeof(T) / sizeof(double)];
  store(in, s), store(c, cosine), store(f, quotient);
  for (std::size_t k = 0; k < sizeof(T) / sizeof(double); ++k) {
    if (in[k] <= kLargestSquare) continue;
    const double y = __builtin_sqrt(in[k]);
    c[k] = portable::cos(y), f[k] = portable::sin(y) / y;
  }
  cosine = load(T(), c), quotient = load(T(), f);
}

template <class T>
RIGOR_INLINE void cosine_and_quotient(T s, T& cosine, T& quotient) {
  cosine = broadcast(T(), 1) + s * polynomial7(s, kCosine);
  quotient = broadcast(T(), 1) + s * polynomial7(s, kSineQuotient);
  if (!all_at_most(s, kLargestSquare)) [[unlikely]]
    large_cosine_and_quotient(s, cosine, quotient);
}

// The unit quaternion of a rotation by twice the vector `half` [rad].
template <class T>
RIGOR_INLINE Q4<T> rotation_by_twice(V3<T> half) {
  T cosine, quotient;
  cosine_and_quotient(dot(half, half), cosine, quotient);
  return {cosine, quotient * half.x, quotient * half.y, quotient * half.z};
}
