// The stages of Runge–Kutta methods; kernels.h describes them. Each kernels_*.cpp includes this file once; it has no
// guard on purpose.

// Orientations are carried through a step as quaternions, of which only the direction counts …
struct QuaternionChart {
  template <class T>
  RIGOR_INLINE static Q4<T> start(T, const Bodies& b, const double* state, std::size_t i) {
    return get4(T(), state, b, kOrientation, i);
  }
  template <class T>
  RIGOR_INLINE static Q4<T> rate(const Bodies&, const double*, std::size_t, Q4<T> q, V3<T> w) {
    return (broadcast(T(), 0.5) * w) * q;
  }
  template <class T>
  RIGOR_INLINE static Q4<T> orientation(const Bodies&, const StageTables&, std::size_t, Q4<T> carried) {
    return normalised(carried);
  }
  template <class T>
  RIGOR_INLINE static void keep(const Bodies&, double*, std::size_t, Q4<T>) {}
};

// … or as rotation vectors from its start, in the places x, y, z of a quaternion (classical_runge_kutta.h has their
// rate).
struct RotationVectorChart {
  template <class T>
  RIGOR_INLINE static Q4<T> start(T, const Bodies&, const double*, std::size_t) {
    return {T{}, T{}, T{}, T{}};
  }
  template <class T>
  RIGOR_INLINE static Q4<T> rate(const Bodies& b, const double* carried, std::size_t i, Q4<T>, V3<T> w) {
    if (!carried) return {T{}, w.x, w.y, w.z};
    const V3<T> phi = get3(T(), carried, b, kTurned, i), turn = cross(phi, w);
    const V3<T> rate = w - broadcast(T(), 0.5) * turn + broadcast(T(), 1.0 / 12) * cross(phi, turn);
    return {T{}, rate.x, rate.y, rate.z};
  }
  template <class T>
  RIGOR_INLINE static Q4<T> orientation(const Bodies& b, const StageTables& t, std::size_t i, Q4<T> carried) {
    const V3<T> half = broadcast(T(), 0.5) * V3<T>{carried.x, carried.y, carried.z};
    return nearly_unit_normalised(rotation_by_twice(half) * get4(T(), t.state, b, kOrientation, i));
  }
  template <class T>
  RIGOR_INLINE static void keep(const Bodies& b, double* carried, std::size_t i, Q4<T> phi) {
    put3(carried, b, kTurned, i, V3<T>{phi.x, phi.y, phi.z});
  }
};

// The rates at a stage, and values that are carried along them.
template <class T>
struct Carried {
  V3<T> x;
  Q4<T> q;
  V3<T> v, L;
};
template <class T>
RIGOR_INLINE Carried<T> plus(const Carried<T>& y, T h, const Carried<T>& rate) {
  return {y.x + h * rate.x, y.q + h * rate.q, y.v + h * rate.v, y.L + h * rate.L};
}

template <class T>
RIGOR_INLINE Carried<T> get_carried(T, const double* table, const Bodies& b, std::size_t i) {
  return {get3(T(), table, b, kPosition, i), get4(T(), table, b, kOrientation, i), get3(T(), table, b, kVelocity, i),
          get3(T(), table, b, kAngularVelocity, i)};
}

template <class T>
RIGOR_INLINE void put_carried(double* table, const Bodies& b, std::size_t i, const Carried<T>& y) {
  put3(table, b, kPosition, i, y.x), put4(table, b, kOrientation, i, y.q);
  put3(table, b, kVelocity, i, y.v), put3(table, b, kAngularVelocity, i, y.L);
}

// The motion that carried values mean, to `out`.
template <class Chart, class T>
RIGOR_INLINE void put_motion(double* out, const Bodies& b, const StageTables& t, std::size_t i, const Carried<T>& y) {
  const Q4<T> q = Chart::orientation(b, t, i, y.q);
  put3(out, b, kPosition, i, y.x), put4(out, b, kOrientation, i, q), put3(out, b, kVelocity, i, y.v);
  put3(out, b, kAngularVelocity, i, times_inertia_in_world(b, kInverseInertia, i, q, y.L));
}

template <class Chart>
RIGOR_INLINE void runge_kutta_stage(const Bodies& b, const StageTables& t, const double* wrench, Stage where,
                                    double weight, double next) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const bool first = where == Stage::first;
    const Carried<T> at = get_carried(T(), first ? t.state : t.stage, b, i);  // with w for L
    const V3<T> zero = {T{}, T{}, T{}};
    V3<T> torque = zero;
    if (wrench) torque = get3(T(), wrench, b, kTorque, i);
    if (wrench && b.has_fixed) torque = get(T(), b.constants, b, kMoves, i) * torque;
    const Carried<T> rates = {at.v, Chart::rate(b, first ? nullptr : t.carried, i, at.q, at.L),
                              acceleration(T(), b, i, wrench), torque};
    Carried<T> start = get_carried(T(), t.state, b, i);
    start.q = Chart::start(T(), b, t.state, i);
    start.L = first ? times_inertia_in_world(b, kInertia, i, at.q, at.L) : get3(T(), t.carried, b, kMomentum, i);
    if (first) put3(t.carried, b, kMomentum, i, start.L);
    const Carried<T> sum = plus(first ? start : get_carried(T(), t.sum, b, i), broadcast(T(), weight), rates);
    if (where == Stage::last) {
      put_motion<Chart>(t.state, b, t, i, sum);
      return;
    }
    put_carried(t.sum, b, i, sum);
    const Carried<T> y = plus(start, broadcast(T(), next), rates);
    Chart::keep(b, t.carried, i, y.q);
    put_motion<Chart>(t.stage, b, t, i, y);
  });
}

void quaternion_stage(const Bodies& b, const StageTables& t, const double* wrench, Stage where, double weight,
                      double next) {
  runge_kutta_stage<QuaternionChart>(b, t, wrench, where, weight, next);
}

void rotation_vector_stage(const Bodies& b, const StageTables& t, const double* wrench, Stage where, double weight,
                           double next) {
  runge_kutta_stage<RotationVectorChart>(b, t, wrench, where, weight, next);
}

// For methods that keep the rates of several stages: y is a table of x, quaternion, v, L.

void motion_of(const Bodies& b, const double* y, std::size_t stride_of_y, double* state) {
  Bodies rows_of_y = b;
  rows_of_y.stride = stride_of_y;
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    put_motion<QuaternionChart>(state, b, StageTables{}, i, get_carried(T(), y, rows_of_y, i));
  });
}

void rates_at(const Bodies& b, const double* state, const double* wrench, double* rates) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const Carried<T> at = get_carried(T(), state, b, i);  // with w for L
    V3<T> torque = {T{}, T{}, T{}};
    if (wrench) torque = get(T(), b.constants, b, kMoves, i) * get3(T(), wrench, b, kTorque, i);
    const Q4<T> turning = QuaternionChart::rate(b, nullptr, i, at.q, at.L);
    put_carried(rates, b, i, Carried<T>{at.v, turning, acceleration(T(), b, i, wrench), torque});
  });
}

void combine(const Bodies& b, const double* y, double h, const double* weights, const double* const* rates,
             std::size_t count, double* out) {
  for (int c = 0; c < kRotation; ++c) {
    for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
      using T = decltype(lane);
      T sum = broadcast(T(), weights[0]) * get(T(), rates[0], b, c, i);
      for (std::size_t s = 1; s < count; ++s) {
        if (weights[s] != 0) sum = sum + broadcast(T(), weights[s]) * get(T(), rates[s], b, c, i);
      }
      if (y) sum = get(T(), y, b, c, i) + broadcast(T(), h) * sum;
      store(out + static_cast<std::size_t>(c) * b.stride + i, sum);
    });
  }
}

template <class T>
RIGOR_INLINE T length(V3<T> a) {
  return square_root(dot(a, a));
}

double relative_size(const Bodies& b, const double* change, const double* y) {
  double largest = 0;
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const T one = broadcast(T(), 1);
    const Carried<T> d = get_carried(T(), change, b, i), at = get_carried(T(), y, b, i);
    const Q4<T> q = normalised(at.q);
    const T spin = length(times_inertia_in_world(b, kInverseInertia, i, q, at.L));
    const T spin_change = length(times_inertia_in_world(b, kInverseInertia, i, q, d.L));
    const T angle = broadcast(T(), 2) * square_root(squared_norm(d.q));
    const T size =
        length(d.x) / (one + length(at.x)) + length(d.v) / (one + length(at.v)) + spin_change / (one + spin) + angle;
    double sizes[sizeof(T) / sizeof(double)];
    store(sizes, size);
    for (std::size_t k = 0; k < sizeof(T) / sizeof(double) && i + k < b.end; ++k) {
      // A value that is not a number must not be lost in a comparison. Fixed bodies do not count.
      if (get(double(), b.constants, b, kMoves, i + k) > 0 && !(sizes[k] <= largest)) largest = sizes[k];
    }
  });
  return largest;
}
