// Contact constraints, several at once. contact_kernels.h describes the results, contact/impulse/impulse.cpp the
// method. Each kernels_*.cpp includes this file once; it has no guard on purpose.

template <class T>
RIGOR_INLINE T at_least_zero(T x) {
  return if_at_most(x, T{}, T{}, x);
}

// The bodies of as many of a group's pairs as T has lanes, from its k-th on.
template <class T>
struct PairLanes {
  Twist<T> a, b;

  RIGOR_INLINE PairLanes(T, const RowGroup& group, std::size_t k, const double* records)
      : a(twist_of(get_record(T(), records, group.a + k))), b(twist_of(get_record(T(), records, group.b + k))) {}
  RIGOR_INLINE void put(const RowGroup& group, std::size_t k, double* records) const {
    put_record(records, group.to_a + k, record_of(a), kTwist);
    put_record(records, group.to_b + k, record_of(b), kTwist);
  }
};

// Rows of a block, as many as T has lanes.
template <class T>
struct RowLanes {
  using Lanes = T;
  double* at = nullptr;

  RIGOR_INLINE T get(int column) const { return load(T(), at + static_cast<std::size_t>(column) * kRowsPerBlock); }
  RIGOR_INLINE V3<T> get3(int column) const { return {get(column), get(column + 1), get(column + 2)}; }
  RIGOR_INLINE void put(int column, T x) const { store(at + static_cast<std::size_t>(column) * kRowsPerBlock, x); }
  RIGOR_INLINE void put3(int column, V3<T> x) const { put(column, x.x), put(column + 1, x.y), put(column + 2, x.z); }
  // An impulse at the bodies' centres.
  RIGOR_INLINE void push(PairLanes<T>& pair, V3<T> impulse) const {
    pair.a.v = pair.a.v + get(kInverseMassA) * impulse;
    pair.b.v = pair.b.v - get(kInverseMassB) * impulse;
  }
  // Coulomb's disc for an impulse p_n along the normal: its radius, which may be infinite.
  RIGOR_INLINE T most_friction(T p_n) const { return if_at_most(p_n, T{}, T{}, get(kFriction) * p_n); }
};

template <class T>
RIGOR_INLINE Symmetric<T> inertia_of(const Record<T>& r) {
  return {r.c[0], r.c[1], r.c[2], r.c[3], r.c[4], r.c[5]};
}

// Across n, and across the axis that n leans to least.
template <class T>
RIGOR_INLINE V3<T> tangent_of(V3<T> n) {
  const T zero = T{};
  const auto size = [&](T x) RIGOR_LAMBDA { return if_at_most(x, zero, zero - x, x); };
  const T x = size(n.x), y = size(n.y), z = size(n.z);
  const auto pick = [&](T across_x, T across_y, T across_z) RIGOR_LAMBDA {
    return if_at_most(x, y, if_at_most(x, z, across_x, across_z), if_at_most(y, z, across_y, across_z));
  };
  const V3<T> t = {pick(zero, zero - n.z, n.y), pick(n.z, zero, zero - n.x), pick(zero - n.y, n.x, zero)};
  return (broadcast(T(), 1) / square_root(dot(t, t))) * t;
}

// Rows of any two bodies, and their inverse inertias.
template <class T>
struct AnyRow : RowLanes<T> {
  using RowLanes<T>::get;
  using RowLanes<T>::get3;
  using RowLanes<T>::put;
  using RowLanes<T>::put3;
  Symmetric<T> inertia_a, inertia_b;

  RIGOR_INLINE void load_pair(const RowGroup& group, std::size_t k, const SolverBodies& bodies) {
    inertia_a = inertia_of(get_record(T(), bodies.inverse_inertias, group.a + k));
    inertia_b = inertia_of(get_record(T(), bodies.inverse_inertias, group.b + k));
  }

  RIGOR_INLINE void prepare(const Record<T>& of_a, const Record<T>& of_b) {
    inertia_a = inertia_of(of_a), inertia_b = inertia_of(of_b);
    const V3<T> n = get3(kNormal), t = tangent_of(n), s = cross(n, t), arm_a = get3(kArmA), arm_b = get3(kArmB);
    const V3<T> friction = get3(kFrictionImpulse);
    put(kTangentImpulse, dot(t, friction)), put(kTangentImpulse + 1, dot(s, friction));
    put3(kTangent, t);
    // The inverse effective mass: a unit impulse along e changes the velocity along d by d · (I⁻¹ (arm x e) x arm).
    const auto K = [&](V3<T> d, V3<T> e) RIGOR_LAMBDA {
      return dot(d, cross(inertia_a * cross(arm_a, e), arm_a)) + dot(d, cross(inertia_b * cross(arm_b, e), arm_b));
    };
    const T one = broadcast(T(), 1), half = broadcast(T(), 0.5);
    const T free = of_a.c[6] + of_b.c[6], nn = free + K(n, n), tt = free + K(t, t), ss = free + K(s, s), ts = K(s, t);
    const T inverse = one / (tt * ss - ts * ts), apart = half * (tt - ss);
    put(kNormalMass, one / nn);
    put(kTangentMass, ss * inverse), put(kTangentMass + 1, tt * inverse), put(kTangentMass + 2, T{} - ts * inverse);
    put(kSlipMass, one / (half * (tt + ss) + square_root(apart * apart + ts * ts)));
  }

  // The difference of the points of `a` and `b`.
  RIGOR_INLINE V3<T> velocity(const PairLanes<T>& pair) const {
    return (pair.a.v + cross(pair.a.w, get3(kArmA))) - (pair.b.v + cross(pair.b.w, get3(kArmB)));
  }
  RIGOR_INLINE T normal_velocity(const PairLanes<T>& pair, V3<T> n) const { return dot(n, velocity(pair)); }

  RIGOR_INLINE void apply(PairLanes<T>& pair, V3<T> impulse) const {
    this->push(pair, impulse);
    pair.a.w = pair.a.w + inertia_a * cross(get3(kArmA), impulse);
    pair.b.w = pair.b.w - inertia_b * cross(get3(kArmB), impulse);
  }
  RIGOR_INLINE void apply_normal(PairLanes<T>& pair, V3<T> n, T p) const { apply(pair, p * n); }
  RIGOR_INLINE void apply_friction(PairLanes<T>& pair, V3<T> n) const {
    const V3<T> t = get3(kTangent);
    apply(pair, get(kTangentImpulse) * t + get(kTangentImpulse + 1) * cross(n, t));
  }

  RIGOR_INLINE void solve_friction(PairLanes<T>& pair, V3<T> n, T p_n) const {
    const V3<T> t = get3(kTangent), s = cross(n, t), u = velocity(pair);
    const T slip_t = dot(t, u), slip_s = dot(s, u), old_t = get(kTangentImpulse), old_s = get(kTangentImpulse + 1);
    const T radius = this->most_friction(p_n), radius2 = radius * radius;
    // Sticking.
    const T cross_mass = get(kTangentMass + 2);
    T p_t = old_t - (get(kTangentMass) * slip_t + cross_mass * slip_s);
    T p_s = old_s - (cross_mass * slip_t + get(kTangentMass + 1) * slip_s);
    const T stick2 = p_t * p_t + p_s * p_s;
    if (!all_at_most(stick2 - radius2, 0)) {
      // Sliding: the impulse must oppose the slip, which only a step with one mass for all directions converges to.
      const T mass = get(kSlipMass), x = old_t - mass * slip_t, y = old_s - mass * slip_s, slip2 = x * x + y * y;
      const T onto = if_at_most(slip2, radius2, broadcast(T(), 1), radius / square_root(slip2));
      p_t = if_at_most(stick2, radius2, p_t, onto * x), p_s = if_at_most(stick2, radius2, p_s, onto * y);
    }
    apply(pair, (p_t - old_t) * t + (p_s - old_s) * s);
    put(kTangentImpulse, p_t), put(kTangentImpulse + 1, p_s);
  }
};

// Rows of balls: an impulse along the normal causes no rotation, and all directions across the normal are equivalent.
template <class T>
struct BallRow : RowLanes<T> {
  using RowLanes<T>::get;
  using RowLanes<T>::get3;
  using RowLanes<T>::put;
  using RowLanes<T>::put3;

  RIGOR_INLINE void load_pair(const RowGroup&, std::size_t, const SolverBodies&) {}
  RIGOR_INLINE void prepare(const Record<T>& of_a, const Record<T>& of_b) const {
    const V3<T> n = get3(kNormal), friction = get3(kFrictionImpulse);
    const T l_a = get(kLengthA), l_b = get(kLengthB), one = broadcast(T(), 1);
    const T turn_a = l_a * of_a.c[0], turn_b = l_b * of_b.c[0], free = of_a.c[6] + of_b.c[6];
    put3(kFrictionImpulse, friction - dot(n, friction) * n);
    put(kTurnA, turn_a), put(kTurnB, turn_b);
    put(kNormalMass, one / free), put(kAcrossMass, one / (free + (l_a * turn_a + l_b * turn_b)));
  }

  RIGOR_INLINE T normal_velocity(const PairLanes<T>& pair, V3<T> n) const { return dot(n, pair.a.v - pair.b.v); }
  RIGOR_INLINE void apply_normal(PairLanes<T>& pair, V3<T> n, T p) const { this->push(pair, p * n); }
  RIGOR_INLINE void apply_across(PairLanes<T>& pair, V3<T> n, V3<T> p) const {
    const V3<T> turn = cross(n, p);
    this->push(pair, p);
    pair.a.w = pair.a.w - get(kTurnA) * turn;
    pair.b.w = pair.b.w - get(kTurnB) * turn;
  }
  RIGOR_INLINE void apply_friction(PairLanes<T>& pair, V3<T> n) const { apply_across(pair, n, get3(kFrictionImpulse)); }

  RIGOR_INLINE void solve_friction(PairLanes<T>& pair, V3<T> n, T p_n) const {
    const V3<T> u = (pair.a.v - pair.b.v) + cross(n, get(kLengthA) * pair.a.w + get(kLengthB) * pair.b.w);
    const V3<T> old = get3(kFrictionImpulse), stick = old - get(kAcrossMass) * (u - dot(n, u) * n);
    const T radius = this->most_friction(p_n), radius2 = radius * radius, stick2 = dot(stick, stick);
    V3<T> p = stick;
    if (!all_at_most(stick2 - radius2, 0))
      p = if_at_most(stick2, radius2, broadcast(T(), 1), radius / square_root(stick2)) * stick;
    apply_across(pair, n, p - old);
    put3(kFrictionImpulse, p);
  }
};

template <class T>
RIGOR_INLINE AnyRow<T> any_row(T) {
  return AnyRow<T>();
}
template <class T>
RIGOR_INLINE BallRow<T> ball_row(T) {
  return BallRow<T>();
}
// Calls f(a row of its kind, group) for each group.
template <class F>
RIGOR_INLINE void for_groups(const RowGroup* groups, std::size_t count, F f) {
  for (const RowGroup* group = groups; group != groups + count; ++group) {
    if (group->of_balls) {
      f(ball_row(Lane()), *group);
    } else {
      f(any_row(Lane()), *group);
    }
  }
}
// Calls f(row) for the rows of all points in the lanes from the k-th on.
template <class Row, class F>
RIGOR_INLINE void for_points(Row row, const RowGroup& group, std::size_t k, F f) {
  for (std::int32_t point = 0; point < group.points; ++point) {
    row.at = group.block(static_cast<std::size_t>(point)) + k;
    f(row);
  }
}

void prepare_rows(const RowGroup* groups, std::size_t count, const SolverBodies& bodies) {
  for_groups(groups, count, [&](auto kind, const RowGroup& group) RIGOR_LAMBDA {
    using T = typename decltype(kind)::Lanes;
    for (std::size_t k = 0; k < kRowsPerBlock; k += kWidth) {
      const Record<T> inertia_a = get_record(T(), bodies.inverse_inertias, group.a + k),
                      inertia_b = get_record(T(), bodies.inverse_inertias, group.b + k);
      for_points(kind, group, k, [&](auto row) RIGOR_LAMBDA {
        row.put(kInverseMassA, inertia_a.c[6]), row.put(kInverseMassB, inertia_b.c[6]);
        row.prepare(inertia_a, inertia_b);
      });
    }
  });
}

// Whether any row of a block comes together faster than the threshold.
RIGOR_INLINE bool may_meet(const double* block, const SolverParameters& parameters) {
  bool is_any = false;
  for (std::size_t k = 0; k < kRowsPerBlock; k += kWidth)
    is_any = is_any ||
             !all_at_most(load(Lane(), block + kApproachSpeed * kRowsPerBlock + k), parameters.restitution_threshold);
  return is_any;
}

std::size_t prepare_bias(const RowGroup* first, std::size_t begin, std::size_t end, const SolverBodies& bodies,
                         const SolverParameters& parameters, RowPlace* impacts) {
  std::size_t found = 0;
  for_groups(first + begin, end - begin, [&](auto kind, const RowGroup& group) RIGOR_LAMBDA {
    using T = typename decltype(kind)::Lanes;
    for (std::size_t k = 0; k < kRowsPerBlock; k += kWidth) {
      const PairLanes<T> pair(T(), group, k, bodies.velocities), change(T(), group, k, bodies.displacements);
      for_points(kind, group, k, [&](auto row) RIGOR_LAMBDA {
        const V3<T> n = row.get3(kNormal);
        const T gap = row.get(kInitialGap) + row.normal_velocity(change, n);
        const T approach = T{} - row.normal_velocity(pair, n);
        row.put(kGap, gap), row.put(kApproachSpeed, approach);
        const T push = broadcast(T(), parameters.bias_rate) * gap, fastest = broadcast(T(), -parameters.max_push_speed),
                touching = broadcast(T(), parameters.touching);
        // Speculative: the gap closes by h (theta u' + (1 - theta) u), of which only the velocity after, u', can be
        // chosen.
        const T closing = broadcast(T(), 1 / (parameters.h * parameters.theta)) * gap -
                          broadcast(T(), (1 - parameters.theta) / parameters.theta) * approach;
        row.put(kBias, if_at_most(gap, touching, if_at_most(push, fastest, fastest, push), closing));
      });
    }
    for (std::int32_t point = 0; point < group.points; ++point) {
      const double* block = group.block(static_cast<std::size_t>(point));
      if (!may_meet(block, parameters)) continue;
      for (std::size_t k = 0; k < kRowsPerBlock; ++k) {
        // It meets in this sub-step, if it hardly speeds up.
        const double u = block[kApproachSpeed * kRowsPerBlock + k], gap = block[kGap * kRowsPerBlock + k];
        if (u > parameters.restitution_threshold && gap < 2 * parameters.h * u)
          impacts[found++] = {static_cast<std::int32_t>(&group - first), static_cast<std::int16_t>(point),
                              static_cast<std::int16_t>(k)};
      }
    }
  });
  return found;
}

// Calls solve(row, pair) for all rows; it returns whether it has changed the pair's velocities.
template <class F>
RIGOR_INLINE void solve_rows(const RowGroup* groups, std::size_t count, const SolverBodies& bodies, F solve) {
  for_groups(groups, count, [&](auto kind, const RowGroup& group) RIGOR_LAMBDA {
    using T = typename decltype(kind)::Lanes;
    for (std::size_t k = 0; k < kRowsPerBlock; k += kWidth) {
      PairLanes<T> pair(T(), group, k, bodies.velocities);
      bool is_changed = false;
      kind.load_pair(group, k, bodies);
      for_points(kind, group, k, [&](auto row) RIGOR_LAMBDA { is_changed |= solve(row, pair); });
      if (is_changed) pair.put(group, k, bodies.velocities);
    }
  });
}

void warm_start(const RowGroup* groups, std::size_t count, const SolverBodies& bodies) {
  solve_rows(groups, count, bodies, [&](auto row, auto& pair) RIGOR_LAMBDA {
    const auto p = row.get(kImpulse);
    if (all_at_most(p, 0)) return false;
    const auto n = row.get3(kNormal);
    row.apply_normal(pair, n, p);
    row.apply_friction(pair, n);
    return true;
  });
}

// `change`: by how much the impulse changes the velocity along the normal.
template <class Row, class T>
RIGOR_INLINE bool solve_row_with_bias(Row row, PairLanes<T>& pair, const SolverParameters& parameters, T& change) {
  const V3<T> n = row.get3(kNormal);
  const T gap = row.get(kGap), old = row.get(kImpulse), mass = row.get(kNormalMass);
  const T touching = broadcast(T(), parameters.touching);
  const T mass_scale = if_at_most(gap, touching, broadcast(T(), parameters.mass_scale), broadcast(T(), 1));
  const T impulse_scale = if_at_most(gap, touching, broadcast(T(), parameters.impulse_scale), T{});
  const T delta = T{} - mass_scale * ((row.normal_velocity(pair, n) + row.get(kBias)) * mass) - impulse_scale * old;
  const T p_n = at_least_zero(old + delta);
  change = T{};
  if (all_at_most(old, 0) && all_at_most(p_n, 0)) return false;
  change = (p_n - old) / mass;
  row.apply_normal(pair, n, p_n - old);
  row.put(kImpulse, p_n);
  row.solve_friction(pair, n, p_n);
  return true;
}

void solve_with_bias(const RowGroup* groups, std::size_t count, const SolverBodies& bodies,
                     const SolverParameters& parameters) {
  solve_rows(groups, count, bodies, [&](auto row, auto& pair) RIGOR_LAMBDA {
    typename decltype(row)::Lanes change;
    return solve_row_with_bias(row, pair, parameters, change);
  });
}

template <class Row, class T>
RIGOR_INLINE bool relax_row(Row row, PairLanes<T>& pair, T& change) {
  const T old = row.get(kImpulse);
  change = T{};
  if (all_at_most(old, 0)) return false;
  const V3<T> n = row.get3(kNormal);
  const T mass = row.get(kNormalMass),
          p_n = if_at_most(old, T{}, old, at_least_zero(old - row.normal_velocity(pair, n) * mass));
  change = (p_n - old) / mass;
  row.apply_normal(pair, n, p_n - old);
  row.put(kImpulse, p_n);
  row.solve_friction(pair, n, p_n);
  return true;
}

void relax(const RowGroup* groups, std::size_t count, const SolverBodies& bodies) {
  solve_rows(groups, count, bodies, [&](auto row, auto& pair) RIGOR_LAMBDA {
    typename decltype(row)::Lanes change;
    return relax_row(row, pair, change);
  });
}

// Whether a change of velocity is more than the tolerance.
template <class T>
RIGOR_INLINE bool is_more(T change, const SolverParameters& parameters) {
  return !all_at_most(change * change, parameters.tolerance * parameters.tolerance);
}

bool sweep_with_bias(const RowGroup* groups, std::size_t count, const SolverBodies& bodies,
                     const SolverParameters& parameters) {
  bool is_any_changed = false;
  solve_rows(groups, count, bodies, [&](auto row, auto& pair) RIGOR_LAMBDA {
    typename decltype(row)::Lanes change;
    const bool is_solved = solve_row_with_bias(row, pair, parameters, change);
    is_any_changed = is_any_changed || is_more(change, parameters);
    return is_solved;
  });
  return is_any_changed;
}

bool sweep_without_bias(const RowGroup* groups, std::size_t count, const SolverBodies& bodies,
                        const SolverParameters& parameters) {
  bool is_any_changed = false;
  solve_rows(groups, count, bodies, [&](auto row, auto& pair) RIGOR_LAMBDA {
    typename decltype(row)::Lanes change;
    const bool is_solved = relax_row(row, pair, change);
    is_any_changed = is_any_changed || is_more(change, parameters);
    return is_solved;
  });
  return is_any_changed;
}
