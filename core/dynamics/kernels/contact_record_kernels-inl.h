// Kernels between records of bodies (contact_rows.h) and the state; kernels.h describes the results. Each kernels_*.cpp
// includes this file once; it has no guard on purpose.

constexpr std::size_t kTwist = 6;  // columns of a record that holds v and w

// Eight columns of as many bodies as T has lanes.
template <class T>
struct Record {
  T c[kRecord];
};
template <class T>
RIGOR_INLINE Record<T> get_record(T, const double* records, const std::int32_t* rows) {
  Record<T> r;
  for (std::size_t c = 0; c < kRecord; c += 2) {
    load_two([&](std::size_t k) RIGOR_LAMBDA { return records + kRecord * static_cast<std::size_t>(rows[k]) + c; },
             r.c[c], r.c[c + 1]);
  }
  return r;
}
// Writes the first columns; their number is even.
template <class T>
RIGOR_INLINE void put_record(double* records, const std::int32_t* rows, const Record<T>& r,
                             std::size_t columns = kRecord) {
  for (std::size_t c = 0; c < columns; c += 2) {
    store_two([&](std::size_t k) RIGOR_LAMBDA { return records + kRecord * static_cast<std::size_t>(rows[k]) + c; },
              r.c[c], r.c[c + 1]);
  }
}
// The bodies i, i + 1, ….
template <class T>
RIGOR_INLINE void put_records(double* records, std::size_t i, const Record<T>& r) {
  std::int32_t rows[kRowsPerBlock];
  for (std::size_t k = 0; k < width_of(T()); ++k) rows[k] = static_cast<std::int32_t>(i + k);
  put_record(records, rows, r);
}
template <class T>
RIGOR_INLINE Record<T> get_records(T, const double* records, std::size_t i) {
  std::int32_t rows[kRowsPerBlock];
  for (std::size_t k = 0; k < width_of(T()); ++k) rows[k] = static_cast<std::int32_t>(i + k);
  return get_record(T(), records, rows);
}

template <class T>
struct Twist {
  V3<T> v, w;
};
template <class T>
RIGOR_INLINE Twist<T> twist_of(const Record<T>& r) {
  return {{r.c[0], r.c[1], r.c[2]}, {r.c[3], r.c[4], r.c[5]}};
}
template <class T>
RIGOR_INLINE Record<T> record_of(const Twist<T>& u) {
  return {{u.v.x, u.v.y, u.v.z, u.w.x, u.w.y, u.w.z, T{}, T{}}};
}

void gather_velocities(const Bodies& b, const double* state, double* velocities) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    put_records(velocities, i,
                record_of(Twist<T>{get3(T(), state, b, kVelocity, i), get3(T(), state, b, kAngularVelocity, i)}));
  });
}

void scatter_velocities(const Bodies& b, const double* velocities, double* state) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const Twist<T> u = twist_of(get_records(T(), velocities, i));
    put3(state, b, kVelocity, i, u.v), put3(state, b, kAngularVelocity, i, u.w);
  });
}

void gather_inverse_inertias(const Bodies& b, const double* state, double* inverse_inertias) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const T mass = get(T(), b.constants, b, kInverseMass, i);
    const Symmetric<T> I = symmetric(T(), b, kInverseInertia, i);
    if (b.round) {
      put_records(inverse_inertias, i, Record<T>{{I.xx, I.yy, I.zz, T{}, T{}, T{}, mass, T{}}});
      return;
    }
    const M3<T> R = matrix_of(get4(T(), state, b, kOrientation, i));
    const V3<T> x = I * R.x, y = I * R.y, z = I * R.z;  // columns of I Rᵀ
    put_records(inverse_inertias, i,
                Record<T>{{dot(R.x, x), dot(R.y, y), dot(R.z, z), dot(R.x, y), dot(R.x, z), dot(R.y, z), mass, T{}}});
  });
}

// How a body has moved since `start`.
template <class T>
RIGOR_INLINE Twist<T> displacement(T, const Bodies& b, std::size_t i, const double* state, const double* start) {
  const Q4<T> q0 = get4(T(), start, b, kOrientation, i);
  const Q4<T> turn = get4(T(), state, b, kOrientation, i) * Q4<T>{q0.w, T{} - q0.x, T{} - q0.y, T{} - q0.z};
  const T two = if_at_most(turn.w, T{}, broadcast(T(), -2), broadcast(T(), 2));
  return {get3(T(), state, b, kPosition, i) - get3(T(), start, b, kPosition, i), two * V3<T>{turn.x, turn.y, turn.z}};
}

void gather_pushed(const Bodies& b, const double* state, const double* pushes, double* velocities) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const Twist<T> push = twist_of(get_records(T(), pushes, i));
    put_records(velocities, i,
                record_of(Twist<T>{get3(T(), state, b, kVelocity, i) + push.v,
                                   get3(T(), state, b, kAngularVelocity, i) + push.w}));
  });
}

void scatter_pushed(const Bodies& b, const double* velocities, double* state, double* pushes) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const Twist<T> u = twist_of(get_records(T(), velocities, i));
    put_records(
        pushes, i,
        record_of(Twist<T>{u.v - get3(T(), state, b, kVelocity, i), u.w - get3(T(), state, b, kAngularVelocity, i)}));
    put3(state, b, kVelocity, i, u.v), put3(state, b, kAngularVelocity, i, u.w);
  });
}

void integrate_corrections(const Bodies& b, const double* velocities, double h, double* state, const double* start,
                           double* displacements) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const Twist<T> u = twist_of(get_records(T(), velocities, i));
    const V3<T> moved = broadcast(T(), h) * (u.v - get3(T(), state, b, kVelocity, i));
    const V3<T> half_turn = broadcast(T(), 0.5 * h) * (u.w - get3(T(), state, b, kAngularVelocity, i));
    put3(state, b, kPosition, i, get3(T(), state, b, kPosition, i) + moved);
    const Q4<T> q = get4(T(), state, b, kOrientation, i);
    const Q4<T> to = nearly_unit_normalised(rotation_by_twice(half_turn) * q);
    const T size = dot(half_turn, half_turn);  // a body that does not rotate keeps every bit
    put4(state, b, kOrientation, i,
         Q4<T>{if_at_most(size, T{}, q.w, to.w), if_at_most(size, T{}, q.x, to.x), if_at_most(size, T{}, q.y, to.y),
               if_at_most(size, T{}, q.z, to.z)});
    put_records(displacements, i, record_of(displacement(T(), b, i, state, start)));
  });
}
