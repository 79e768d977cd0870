// The kernels of ball joints and hinges (ball_rows.h); ball_kernels.h describes each. Each kernels_*.cpp includes this
// file once; it has no guard on purpose.

template <class T>
RIGOR_INLINE V3<T> column3(T, const double* row, int column) {
  return {load(T(), row + 8 * column), load(T(), row + 8 * (column + 1)), load(T(), row + 8 * (column + 2))};
}
template <class T>
RIGOR_INLINE void put_column3(double* row, int column, V3<T> a) {
  store(row + 8 * column, a.x), store(row + 8 * (column + 1), a.y), store(row + 8 * (column + 2), a.z);
}
template <class T>
RIGOR_INLINE V3<T> gather3(T, const double* table, const std::int32_t* start) {
  return {gather(T(), table, start), gather(T(), table + 8, start), gather(T(), table + 16, start)};
}

template <class T>
struct Pose {
  V3<T> x;
  Q4<T> q;
};
template <class T>
RIGOR_INLINE Pose<T> pose_of(const Record<T>& r) {
  return {{r.c[0], r.c[1], r.c[2]}, {r.c[3], r.c[4], r.c[5], r.c[6]}};
}
template <class T>
RIGOR_INLINE Record<T> record_of(const Pose<T>& p) {
  return {{p.x.x, p.x.y, p.x.z, p.q.w, p.q.x, p.q.y, p.q.z, T{}}};
}

void gather_poses(const Bodies& b, const double* state, double* poses) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    put_records(poses, i, record_of(Pose<T>{get3(T(), state, b, kPosition, i), get4(T(), state, b, kOrientation, i)}));
  });
}

// The part of a perpendicular to n, which has length 1 or 0.
template <class T>
RIGOR_INLINE V3<T> across(V3<T> a, V3<T> n) {
  return a - dot(n, a) * n;
}
// The matrix, given by its columns, without its parts along r from the left and along c from the right.
template <class T>
RIGOR_INLINE M3<T> across(const M3<T>& by, V3<T> r, V3<T> c) {
  const M3<T> left = {across(by.x, r), across(by.y, r), across(by.z, r)};
  const V3<T> along = c.x * left.x + c.y * left.y + c.z * left.z;
  return {left.x - c.x * along, left.y - c.y * along, left.z - c.z * along};
}

void prepare_balls(const BallRows& balls, const double* poses, const double* velocities, double h) {
  for_rows(0, balls.pins, [&](auto lane, std::size_t p) RIGOR_LAMBDA {
    using T = decltype(lane);
    double* const row = balls.by_pin + start_of_row(p, kBallColumns);
    const Pose<T> a = pose_of(get_record(T(), poses, balls.a + p)), b = pose_of(get_record(T(), poses, balls.b + p));
    const Twist<T> u = twist_of(get_record(T(), velocities, balls.a + p)),
                   v = twist_of(get_record(T(), velocities, balls.b + p));
    const V3<T> arm_a = matrix_of(a.q) * column3(T(), row, kPinA), arm_b = matrix_of(b.q) * column3(T(), row, kPinB);
    const V3<T> turn_a = cross(u.w, arm_a), turn_b = cross(v.w, arm_b);
    const V3<T> gap = (b.x - a.x) + (arm_b - arm_a), rate = (v.v - u.v) + (turn_b - turn_a);
    const V3<T> bias = cross(v.w, turn_b) - cross(u.w, turn_a);
    put_column3(row, kArmOfA, arm_a), put_column3(row, kArmOfB, arm_b);
    V3<T> right_side = broadcast(T(), -1) * (rate + broadcast(T(), 0.5 * h) * bias + broadcast(T(), 1 / h) * gap);
    if (balls.has_axes) {
      const V3<T> axis = matrix_of(a.q) * column3(T(), row, kAxisInA);
      put_column3(row, kAxis, axis);
      right_side = across(right_side, axis);
    }
    put_column3(row, kRightSide, right_side);
  });
}

// 1/m + [r]x I⁻¹ [s]xᵀ by columns: what unit impulses at the arm s do to the velocity at the arm r.
template <class T>
RIGOR_INLINE M3<T> response_of(const Record<T>& body, V3<T> r, V3<T> s) {
  const T xx = body.c[0], yy = body.c[1], zz = body.c[2], xy = body.c[3], xz = body.c[4], yz = body.c[5];
  M3<T> by = {cross(r, V3<T>{xz * s.y - xy * s.z, yz * s.y - yy * s.z, zz * s.y - yz * s.z}),
              cross(r, V3<T>{xx * s.z - xz * s.x, xy * s.z - yz * s.x, xz * s.z - zz * s.x}),
              cross(r, V3<T>{xy * s.x - xx * s.y, yy * s.x - xy * s.y, yz * s.x - xz * s.y})};
  by.x.x = body.c[6] + by.x.x, by.y.y = body.c[6] + by.y.y, by.z.z = body.c[6] + by.z.z;
  return by;
}

// The part of a symmetric matrix across n from both sides, plus its part along n, so that it has an inverse: D - (n kᵀ
// + k nᵀ) with k = (1 - n nᵀ) D n.
template <class T>
RIGOR_INLINE Symmetric<T> parted(const Symmetric<T>& D, V3<T> n) {
  const V3<T> k = across(D * n, n);
  const T two = broadcast(T(), 2);
  return {D.xx - two * n.x * k.x,         D.yy - two * n.y * k.y,         D.zz - two * n.z * k.z,
          D.xy - (n.x * k.y + k.x * n.y), D.xz - (n.x * k.z + k.x * n.z), D.yz - (n.y * k.z + k.y * n.z)};
}

void assemble_diagonal(const BallRows& balls) {
  for_rows(0, balls.pins, [&](auto lane, std::size_t p) RIGOR_LAMBDA {
    using T = decltype(lane);
    double* const row = balls.by_pin + start_of_row(p, kBallColumns);
    const V3<T> arm_a = column3(T(), row, kArmOfA), arm_b = column3(T(), row, kArmOfB);
    const M3<T> of_a = response_of(get_record(T(), balls.inverse_inertias, balls.a + p), arm_a, arm_a);
    const M3<T> of_b = response_of(get_record(T(), balls.inverse_inertias, balls.b + p), arm_b, arm_b);
    Symmetric<T> D = {of_a.x.x + of_b.x.x, of_a.y.y + of_b.y.y, of_a.z.z + of_b.z.z,
                      of_a.y.x + of_b.y.x, of_a.z.x + of_b.z.x, of_a.z.y + of_b.z.y};
    if (balls.has_axes) D = parted(D, column3(T(), row, kAxis));
    put_column3(row, kDiagonal, V3<T>{D.xx, D.yy, D.zz}), put_column3(row, kDiagonal + 3, V3<T>{D.xy, D.xz, D.yz});
    store(row + 8 * kScale, D.xx * D.yy * D.zz);
  });
}

void assemble_couplings(const BallRows& balls, const BallCouplings& couplings) {
  for_rows(0, couplings.size, [&](auto lane, std::size_t u) RIGOR_LAMBDA {
    using T = decltype(lane);
    double* const row = couplings.blocks + start_of_row(u, kCouplingColumns);
    const T sign = load(T(), row + 8 * kSign);
    M3<T> by = response_of(get_record(T(), balls.inverse_inertias, couplings.body + u),
                           gather3(T(), balls.by_pin, couplings.row_arm + u),
                           gather3(T(), balls.by_pin, couplings.column_arm + u));
    if (balls.has_axes)
      by = across(by, gather3(T(), balls.by_pin, couplings.row_axis + u),
                  gather3(T(), balls.by_pin, couplings.column_axis + u));
    put_column3(row, kBlock, sign * by.x), put_column3(row, kBlock + 3, sign * by.y);
    put_column3(row, kBlock + 6, sign * by.z);
  });
}

void assemble_balls(const BallRows& balls) {
  assemble_diagonal(balls);
  assemble_couplings(balls, balls.first);
  assemble_couplings(balls, balls.other);
}

void push_and_drift(const Bodies& b, const double* start, const double* impulses, const double* inverse_inertias,
                    Turn turn, double dt, double* end, double* poses) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const Twist<T> impulse = twist_of(get_records(T(), impulses, i));
    const Record<T> I = get_records(T(), inverse_inertias, i);
    const V3<T> v = get3(T(), start, b, kVelocity, i) + I.c[6] * impulse.v;
    const V3<T> w = get3(T(), start, b, kAngularVelocity, i) +
                    Symmetric<T>{I.c[0], I.c[1], I.c[2], I.c[3], I.c[4], I.c[5]} * impulse.w;
    const Pose<T> to = {get3(T(), start, b, kPosition, i) + broadcast(T(), dt) * v,
                        turned(get4(T(), start, b, kOrientation, i), w, turn, broadcast(T(), 0.5 * dt))};
    put3(end, b, kPosition, i, to.x), put4(end, b, kOrientation, i, to.q);
    put3(end, b, kVelocity, i, v), put3(end, b, kAngularVelocity, i, w);
    put_records(poses, i, record_of(to));
  });
}

template <class T>
RIGOR_INLINE T size_of(T x) {
  return if_at_most(x, T{}, T{} - x, x);
}
template <class T>
RIGOR_INLINE T larger(T x, T y) {
  return if_at_most(x, y, y, x);
}

double measure_balls(const BallRows& balls, const double* poses, double h) {
  double widest = 0;
  for_rows(0, balls.pins, [&](auto lane, std::size_t p) RIGOR_LAMBDA {
    using T = decltype(lane);
    double* const row = balls.by_pin + start_of_row(p, kBallColumns);
    const Pose<T> a = pose_of(get_record(T(), poses, balls.a + p)), b = pose_of(get_record(T(), poses, balls.b + p));
    const V3<T> reach = matrix_of(a.q) * column3(T(), row, kPinA) - matrix_of(b.q) * column3(T(), row, kPinB);
    const V3<T> gap = (b.x - a.x) - reach;
    V3<T> right_side = broadcast(T(), -1 / h) * gap;
    if (balls.has_axes) right_side = across(right_side, column3(T(), row, kAxis));
    put_column3(row, kReach, reach), put_column3(row, kRightSide, right_side);
    double sizes[width_of(T())];
    store(sizes, larger(larger(size_of(gap.x), size_of(gap.y)), size_of(gap.z)));
    for (const double size : sizes) widest = size <= widest ? widest : size;
  });
  return widest;
}
