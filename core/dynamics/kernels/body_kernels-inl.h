// The kernels over bodies; kernels.h describes each. Each kernels_*.cpp includes this file once; it has no guard on
// purpose.

template <class T>
RIGOR_INLINE T get(T, const double* table, const Bodies& b, int column, std::size_t i) {
  return load(T(), table + static_cast<std::size_t>(column) * b.stride + i);
}
template <class T>
RIGOR_INLINE V3<T> get3(T, const double* table, const Bodies& b, int column, std::size_t i) {
  return {get(T(), table, b, column, i), get(T(), table, b, column + 1, i), get(T(), table, b, column + 2, i)};
}
template <class T>
RIGOR_INLINE Q4<T> get4(T, const double* table, const Bodies& b, int column, std::size_t i) {
  return {get(T(), table, b, column, i), get(T(), table, b, column + 1, i), get(T(), table, b, column + 2, i),
          get(T(), table, b, column + 3, i)};
}
template <class T>
RIGOR_INLINE void put3(double* table, const Bodies& b, int column, std::size_t i, V3<T> a) {
  double* p = table + static_cast<std::size_t>(column) * b.stride + i;
  store(p, a.x), store(p + b.stride, a.y), store(p + 2 * b.stride, a.z);
}
template <class T>
RIGOR_INLINE void put4(double* table, const Bodies& b, int column, std::size_t i, Q4<T> q) {
  double* p = table + static_cast<std::size_t>(column) * b.stride + i;
  store(p, q.w), store(p + b.stride, q.x), store(p + 2 * b.stride, q.y), store(p + 3 * b.stride, q.z);
}

template <class T>
RIGOR_INLINE Symmetric<T> symmetric(T, const Bodies& b, int column, std::size_t i) {
  const V3<T> diagonal = get3(T(), b.constants, b, column, i), rest = get3(T(), b.constants, b, column + 3, i);
  return {diagonal.x, diagonal.y, diagonal.z, rest.x, rest.y, rest.z};
}
// I a or I⁻¹ a, in B.
template <class T>
RIGOR_INLINE V3<T> times_inertia(const Bodies& b, int column, std::size_t i, V3<T> a) {
  if (b.diagonal) return times_each(get3(T(), b.constants, b, column, i), a);
  return symmetric(T(), b, column, i) * a;
}

// F/m, gravity included [m/s²].
template <class T>
RIGOR_INLINE V3<T> acceleration(T, const Bodies& b, std::size_t i, const double* wrench) {
  V3<T> a = {broadcast(T(), b.gravity[0]), broadcast(T(), b.gravity[1]), broadcast(T(), b.gravity[2])};
  if (b.has_fixed) a = get(T(), b.constants, b, kMoves, i) * a;
  if (wrench) a = a + get(T(), b.constants, b, kInverseMass, i) * get3(T(), wrench, b, kForce, i);
  return a;
}

// w' [rad/s², in W].
template <class T>
RIGOR_INLINE V3<T> angular_acceleration(const Bodies& b, std::size_t i, Q4<T> q, V3<T> w, const double* wrench) {
  const M3<T> R = matrix_of(q);
  const V3<T> w_B = transposed_times(R, w);
  V3<T> rate;
  if (b.diagonal) {
    rate = times_each(get3(T(), b.constants, b, kGyro, i), V3<T>{w_B.y * w_B.z, w_B.z * w_B.x, w_B.x * w_B.y});
    if (wrench) {
      const V3<T> torque = transposed_times(R, get3(T(), wrench, b, kTorque, i));
      rate = rate + times_each(get3(T(), b.constants, b, kInverseInertia, i), torque);
    }
  } else {
    V3<T> rest = cross(symmetric(T(), b, kInertia, i) * w_B, w_B);
    if (wrench) rest = rest + transposed_times(R, get3(T(), wrench, b, kTorque, i));
    rate = symmetric(T(), b, kInverseInertia, i) * rest;
  }
  return R * rate;
}

// I a or I⁻¹ a with both in W.
template <class T>
RIGOR_INLINE V3<T> times_inertia_in_world(const Bodies& b, int column, std::size_t i, Q4<T> q, V3<T> a) {
  const M3<T> R = matrix_of(q);
  return R * times_inertia(b, column, i, transposed_times(R, a));
}

template <class T>
RIGOR_INLINE Q4<T> turned(Q4<T> q, V3<T> w, Turn turn, T half_dt) {
  const V3<T> half = half_dt * w;
  if (turn == Turn::additive) return normalised(q + half * q);
  return nearly_unit_normalised(rotation_by_twice(half) * q);
}

void kick(const Bodies& b, double* state, const double* wrench, double dt) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const T h = broadcast(T(), dt);
    if (wrench || !b.round) {
      const V3<T> w = get3(T(), state, b, kAngularVelocity, i);
      put3(state, b, kAngularVelocity, i,
           w + h * angular_acceleration(b, i, get4(T(), state, b, kOrientation, i), w, wrench));
    }
    if (wrench || b.has_gravity)
      put3(state, b, kVelocity, i, get3(T(), state, b, kVelocity, i) + h * acceleration(T(), b, i, wrench));
  });
}

void drift(const Bodies& b, double* state, Turn turn, double dt) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    put3(state, b, kPosition, i,
         get3(T(), state, b, kPosition, i) + broadcast(T(), dt) * get3(T(), state, b, kVelocity, i));
    put4(state, b, kOrientation, i,
         turned(get4(T(), state, b, kOrientation, i), get3(T(), state, b, kAngularVelocity, i), turn,
                broadcast(T(), 0.5 * dt)));
  });
}

void explicit_step(const Bodies& b, double* state, const double* wrench, Turn turn, double dt) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const T h = broadcast(T(), dt);
    const V3<T> v = get3(T(), state, b, kVelocity, i), w = get3(T(), state, b, kAngularVelocity, i);
    const Q4<T> q = get4(T(), state, b, kOrientation, i);
    put3(state, b, kPosition, i, get3(T(), state, b, kPosition, i) + h * v);
    put4(state, b, kOrientation, i, turned(q, w, turn, broadcast(T(), 0.5 * dt)));
    put3(state, b, kVelocity, i, v + h * acceleration(T(), b, i, wrench));
    put3(state, b, kAngularVelocity, i, w + h * angular_acceleration(b, i, q, w, wrench));
  });
}

void momentum_of(const Bodies& b, const double* state, double* carried) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const Q4<T> q = get4(T(), state, b, kOrientation, i);
    put3(carried, b, kMomentum, i, times_inertia_in_world(b, kInertia, i, q, get3(T(), state, b, kAngularVelocity, i)));
  });
}

void velocity_of(const Bodies& b, double* state, const double* carried) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const Q4<T> q = get4(T(), state, b, kOrientation, i);
    put3(state, b, kAngularVelocity, i,
         times_inertia_in_world(b, kInverseInertia, i, q, get3(T(), carried, b, kMomentum, i)));
  });
}

void momentum_kick(const Bodies& b, double* state, double* carried, const double* wrench, double h) {
  if (!wrench && !b.has_gravity) return;
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    put3(state, b, kVelocity, i,
         get3(T(), state, b, kVelocity, i) + broadcast(T(), h) * acceleration(T(), b, i, wrench));
    if (!wrench) return;
    T moves_h = broadcast(T(), h);
    if (b.has_fixed) moves_h = get(T(), b.constants, b, kMoves, i) * moves_h;
    put3(carried, b, kMomentum, i, get3(T(), carried, b, kMomentum, i) + moves_h * get3(T(), wrench, b, kTorque, i));
  });
}

// q (c, s e_x) and q (c, s e_z).
template <class T>
RIGOR_INLINE Q4<T> turned_about_x(Q4<T> q, T c, T s) {
  return {q.w * c - q.x * s, q.x * c + q.w * s, q.y * c + q.z * s, q.z * c - q.y * s};
}
template <class T>
RIGOR_INLINE Q4<T> turned_about_z(Q4<T> q, T c, T s) {
  return {q.w * c - q.z * s, q.x * c + q.y * s, q.y * c - q.x * s, q.z * c + q.w * s};
}
// L's components along the body's x and z.
template <class T>
RIGOR_INLINE T along_x(Q4<T> q, V3<T> L) {
  return ((q.w * q.w + q.x * q.x) - (q.y * q.y + q.z * q.z)) * L.x +
         ((q.x * q.y + q.w * q.z) * (L.y + L.y) + (q.x * q.z - q.w * q.y) * (L.z + L.z));
}
template <class T>
RIGOR_INLINE T along_z(Q4<T> q, V3<T> L) {
  return ((q.w * q.w + q.z * q.z) - (q.x * q.x + q.y * q.y)) * L.z +
         ((q.x * q.z + q.w * q.y) * (L.x + L.x) + (q.y * q.z - q.w * q.x) * (L.y + L.y));
}

// See free_rotation.h.
template <class T>
RIGOR_INLINE Q4<T> freely_turned(const Bodies& b, std::size_t i, Q4<T> q, V3<T> L, T h) {
  const Q4<T> axes = get4(T(), b.constants, b, kAxes, i);
  if (!b.principal) q = q * axes;
  const T half_h = broadcast(T(), 0.5) * h;
  const T low = broadcast(T(), 0.5) * half_h * get(T(), b.constants, b, kExcessLow, i);
  const T high = half_h * get(T(), b.constants, b, kExcessHigh, i);
  T cosine, quotient;
  T y = low * along_x(q, L);
  cosine_and_quotient(y * y, cosine, quotient);
  q = turned_about_x(q, cosine, y * quotient);
  y = high * along_z(q, L);
  cosine_and_quotient(y * y, cosine, quotient);
  q = turned_about_z(q, cosine, y * quotient);
  y = low * along_x(q, L);
  cosine_and_quotient(y * y, cosine, quotient);
  q = turned_about_x(q, cosine, y * quotient);
  q = rotation_by_twice((half_h * get(T(), b.constants, b, kInverseMedian, i)) * L) * q;
  if (!b.principal) q = q * Q4<T>{axes.w, T{} - axes.x, T{} - axes.y, T{} - axes.z};
  return nearly_unit_normalised(q);
}

void free_drift(const Bodies& b, double* state, const double* carried, double h) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const T step = broadcast(T(), h);
    put3(state, b, kPosition, i, get3(T(), state, b, kPosition, i) + step * get3(T(), state, b, kVelocity, i));
    put4(state, b, kOrientation, i,
         freely_turned(b, i, get4(T(), state, b, kOrientation, i), get3(T(), carried, b, kMomentum, i), step));
  });
}
