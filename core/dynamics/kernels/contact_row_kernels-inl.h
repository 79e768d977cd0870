// Contact constraints, several at once; kernels.h says what comes out, contact/impulse/impulse.cpp has the method.
// Included once by each kernels_*.cpp, on purpose without a guard.

template <class T>
RIGOR_INLINE T at_least_zero(T x) {
  return if_at_most(x, T{}, T{}, x);
}

// As many rows of a block as T has lanes, from its k-th on, with their two bodies.
template <class T>
struct RowLanes {
  RowBlock& block;
  std::size_t k;
  Twist<T> a, b;

  RIGOR_INLINE RowLanes(T, RowBlock& of, std::size_t at, const double* records)
      : block(of),
        k(at),
        a(twist_of(get_record(T(), records, of.a + at))),
        b(twist_of(get_record(T(), records, of.b + at))) {}

  RIGOR_INLINE T get(int column) const { return load(T(), block.columns[column] + k); }
  RIGOR_INLINE V3<T> get3(int column) const { return {get(column), get(column + 1), get(column + 2)}; }
  RIGOR_INLINE void put(int column, T x) const { store(block.columns[column] + k, x); }

  // Of the points of `a` against those of `b`.
  RIGOR_INLINE V3<T> velocity() const { return (a.v + cross(a.w, get3(kArmA))) - (b.v + cross(b.w, get3(kArmB))); }
  RIGOR_INLINE void apply_normal(V3<T> n, T p) {
    a.v = a.v + (get(kInverseMassA) * p) * n, a.w = a.w + p * get3(kAngularA);
    b.v = b.v - (get(kInverseMassB) * p) * n, b.w = b.w - p * get3(kAngularB);
  }
  RIGOR_INLINE void apply_tangential(V3<T> t, V3<T> s, T p_t, T p_s) {
    const V3<T> p = p_t * t + p_s * s;
    a.v = a.v + get(kInverseMassA) * p, a.w = a.w + (p_t * get3(kAngularA + 3) + p_s * get3(kAngularA + 6));
    b.v = b.v - get(kInverseMassB) * p, b.w = b.w - (p_t * get3(kAngularB + 3) + p_s * get3(kAngularB + 6));
  }
  RIGOR_INLINE void put_velocities(double* records) const {
    put_record(records, block.to_a + k, record_of(a));
    put_record(records, block.to_b + k, record_of(b));
  }
};

// Calls f(T(), block, k) for all rows.
template <class F>
RIGOR_INLINE void for_blocks(RowBlock* blocks, std::size_t count, F f) {
  for (RowBlock* block = blocks; block != blocks + count; ++block) {
    for (std::size_t k = 0; k < kRowsPerBlock; k += kWidth) f(Lane(), *block, k);
  }
}

template <class T>
struct Angular {
  V3<T> n, t, s;
};
// What unit impulses at the end of an arm add to w.
template <class T>
RIGOR_INLINE Angular<T> angular_of(const Record<T>& inertia, V3<T> arm, V3<T> n, V3<T> t, V3<T> s) {
  const Symmetric<T> I = {inertia.c[0], inertia.c[1], inertia.c[2], inertia.c[3], inertia.c[4], inertia.c[5]};
  return {I * cross(arm, n), I * cross(arm, t), I * cross(arm, s)};
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

void prepare_rows(RowBlock* blocks, std::size_t count, const SolverBodies& bodies) {
  for_blocks(blocks, count, [&](auto lane, RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    using T = decltype(lane);
    const RowLanes<T> row(T(), block, k, bodies.velocities);
    const auto put3_row = [&](int column, V3<T> x) RIGOR_LAMBDA {
      row.put(column, x.x), row.put(column + 1, x.y), row.put(column + 2, x.z);
    };
    const V3<T> n = row.get3(kNormal), t = tangent_of(n), s = cross(n, t), arm_a = row.get3(kArmA),
                arm_b = row.get3(kArmB);
    const V3<T> friction = row.get3(kAngularA);
    row.put(kImpulse + 1, dot(t, friction)), row.put(kImpulse + 2, dot(s, friction));
    put3_row(kTangent, t);
    const Record<T> inertia_a = get_record(T(), bodies.inverse_inertias, block.a + k),
                    inertia_b = get_record(T(), bodies.inverse_inertias, block.b + k);
    const T mass_a = inertia_a.c[6], mass_b = inertia_b.c[6];
    const Angular<T> angular_a = angular_of(inertia_a, arm_a, n, t, s),
                     angular_b = angular_of(inertia_b, arm_b, n, t, s);
    put3_row(kAngularA, angular_a.n), put3_row(kAngularA + 3, angular_a.t), put3_row(kAngularA + 6, angular_a.s);
    put3_row(kAngularB, angular_b.n), put3_row(kAngularB + 3, angular_b.t), put3_row(kAngularB + 6, angular_b.s);
    row.put(kInverseMassA, mass_a), row.put(kInverseMassB, mass_b);
    // The inverse effective mass: d · (I⁻¹ (arm x e) x arm) is what a unit impulse along e gives of velocity along d.
    const auto K = [&](V3<T> d, V3<T> a, V3<T> b)
                       RIGOR_LAMBDA { return dot(d, cross(a, arm_a)) + dot(d, cross(b, arm_b)); };
    const T free = mass_a + mass_b, one = broadcast(T(), 1), half = broadcast(T(), 0.5);
    const T nn = free + K(n, angular_a.n, angular_b.n), tt = free + K(t, angular_a.t, angular_b.t),
            ss = free + K(s, angular_a.s, angular_b.s), ts = K(s, angular_a.t, angular_b.t);
    const T inverse = one / (tt * ss - ts * ts), apart = half * (tt - ss);
    row.put(kNormalMass, one / nn);
    row.put(kTangentMass, ss * inverse), row.put(kTangentMass + 1, tt * inverse);
    row.put(kTangentMass + 2, T{} - ts * inverse);
    row.put(kSlipMass, one / (half * (tt + ss) + square_root(apart * apart + ts * ts)));
  });
}

std::size_t prepare_bias(RowBlock* blocks, std::size_t count, const SolverBodies& bodies,
                         const SolverParameters& parameters, std::int32_t* impacts) {
  std::size_t found = 0;
  for_blocks(blocks, count, [&](auto lane, RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    using T = decltype(lane);
    const RowLanes<T> row(T(), block, k, bodies.velocities), change(T(), block, k, bodies.displacements);
    const V3<T> n = row.get3(kNormal);
    const T gap = row.get(kInitialGap) + dot(n, change.velocity());
    const T approach = T{} - dot(n, row.velocity());
    row.put(kGap, gap), row.put(kApproachSpeed, approach);
    const T push = broadcast(T(), parameters.bias_rate) * gap, fastest = broadcast(T(), -parameters.max_push_speed);
    // Speculative: the gap closes by h (theta u' + (1 - theta) u), of which only the velocity after, u', can be chosen.
    const T closing = broadcast(T(), 1 / (parameters.h * parameters.theta)) * gap -
                      broadcast(T(), (1 - parameters.theta) / parameters.theta) * approach;
    row.put(kBias, if_at_most(T{}, gap, closing, if_at_most(push, fastest, fastest, push)));
    if (all_at_most(approach, parameters.restitution_threshold)) [[likely]]
      return;
    for (std::size_t j = k; j < k + width_of(T()); ++j) {
      // It meets in this sub-step, if it hardly speeds up.
      const double u = block.columns[kApproachSpeed][j];
      if (u > parameters.restitution_threshold && block.columns[kGap][j] < 2 * parameters.h * u)
        impacts[found++] = static_cast<std::int32_t>(static_cast<std::size_t>(&block - blocks) * kRowsPerBlock + j);
    }
  });
  return found;
}

void warm_start(RowBlock* blocks, std::size_t count, const SolverBodies& bodies) {
  for_blocks(blocks, count, [&](auto lane, RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    using T = decltype(lane);
    if (all_at_most(load(T(), block.columns[kImpulse] + k), 0)) return;
    RowLanes<T> row(T(), block, k, bodies.velocities);
    const V3<T> n = row.get3(kNormal), t = row.get3(kTangent);
    row.apply_normal(n, row.get(kImpulse));
    row.apply_tangential(t, cross(n, t), row.get(kImpulse + 1), row.get(kImpulse + 2));
    row.put_velocities(bodies.velocities);
  });
}

// Coulomb's disc of the normal impulse p_n.
template <class T>
RIGOR_INLINE void solve_friction(RowLanes<T>& row, V3<T> n, T p_n) {
  const V3<T> t = row.get3(kTangent), s = cross(n, t), u = row.velocity();
  const T slip_t = dot(t, u), slip_s = dot(s, u), old_t = row.get(kImpulse + 1), old_s = row.get(kImpulse + 2);
  const T radius = if_at_most(p_n, T{}, T{}, row.get(kFriction) * p_n), radius2 = radius * radius;  // may be infinite
  // Sticking.
  const T cross_mass = row.get(kTangentMass + 2);
  T p_t = old_t - (row.get(kTangentMass) * slip_t + cross_mass * slip_s);
  T p_s = old_s - (cross_mass * slip_t + row.get(kTangentMass + 1) * slip_s);
  const T stick2 = p_t * p_t + p_s * p_s;
  if (!all_at_most(stick2 - radius2, 0)) {
    // Sliding: the impulse must oppose the slip, which only a step with one mass for all directions converges to.
    const T mass = row.get(kSlipMass), x = old_t - mass * slip_t, y = old_s - mass * slip_s, slip2 = x * x + y * y;
    const T onto = if_at_most(slip2, radius2, broadcast(T(), 1), radius / square_root(slip2));
    p_t = if_at_most(stick2, radius2, p_t, onto * x), p_s = if_at_most(stick2, radius2, p_s, onto * y);
  }
  row.apply_tangential(t, s, p_t - old_t, p_s - old_s);
  row.put(kImpulse + 1, p_t), row.put(kImpulse + 2, p_s);
}

// Returns by how much the impulse changes the velocity along the normal.
template <class T>
RIGOR_INLINE T solve_row_with_bias(T, RowBlock& block, std::size_t k, const SolverBodies& bodies,
                                   const SolverParameters& parameters) {
  RowLanes<T> row(T(), block, k, bodies.velocities);
  const V3<T> n = row.get3(kNormal);
  const T gap = row.get(kGap), old = row.get(kImpulse), mass = row.get(kNormalMass);
  const T mass_scale = if_at_most(T{}, gap, broadcast(T(), 1), broadcast(T(), parameters.mass_scale));
  const T impulse_scale = if_at_most(T{}, gap, T{}, broadcast(T(), parameters.impulse_scale));
  const T delta = T{} - mass_scale * ((dot(n, row.velocity()) + row.get(kBias)) * mass) - impulse_scale * old;
  const T p_n = at_least_zero(old + delta);
  if (all_at_most(old, 0) && all_at_most(p_n, 0)) return T{};
  row.apply_normal(n, p_n - old);
  row.put(kImpulse, p_n);
  solve_friction(row, n, p_n);
  row.put_velocities(bodies.velocities);
  return (p_n - old) / mass;
}

void solve_with_bias(RowBlock* blocks, std::size_t count, const SolverBodies& bodies,
                     const SolverParameters& parameters) {
  for_blocks(blocks, count, [&](auto lane, RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    solve_row_with_bias(lane, block, k, bodies, parameters);
  });
}

// Sweeps over some rows, calling solve(block, k), until none changes a velocity by more than the tolerance; from the
// second sweep on only for bodies that the sweep before, or this one, has changed.
template <class F>
RIGOR_INLINE void solve_until_they_agree(RowBlock* blocks, const std::int32_t* rows, std::size_t count,
                                         const SolverBodies& bodies, const SolverParameters& parameters, F solve) {
  for (std::size_t i = 0; i < count; ++i) {
    const RowBlock& block = blocks[rows[i] / kRowsPerBlock];
    bodies.last_active[block.a[rows[i] % kRowsPerBlock]] = bodies.last_active[block.b[rows[i] % kRowsPerBlock]] = 0;
  }
  bool has_converged = count == 0;
  for (int sweep = 0; sweep < parameters.max_sweeps && !has_converged; ++sweep) {
    has_converged = true;
    for (std::size_t i = 0; i < count; ++i) {
      RowBlock& block = blocks[rows[i] / kRowsPerBlock];
      const std::size_t k = rows[i] % kRowsPerBlock;
      if (bodies.last_active[block.a[k]] < sweep - 1 && bodies.last_active[block.b[k]] < sweep - 1) continue;
      const double change = solve(block, k);
      if (change * change <= parameters.tolerance * parameters.tolerance) continue;
      // A fixed body is written to the idle record, and so is never active.
      bodies.last_active[block.to_a[k]] = bodies.last_active[block.to_b[k]] = sweep;
      has_converged = false;
    }
  }
}

void solve_some_with_bias(RowBlock* blocks, const std::int32_t* rows, std::size_t count, const SolverBodies& bodies,
                          const SolverParameters& parameters) {
  solve_until_they_agree(blocks, rows, count, bodies, parameters, [&](RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    return solve_row_with_bias(double(), block, k, bodies, parameters);
  });
}

// Returns by how much the impulse changes the velocity along the normal.
template <class T>
RIGOR_INLINE T relax_row(T, RowBlock& block, std::size_t k, const SolverBodies& bodies) {
  const T old = load(T(), block.columns[kImpulse] + k);
  if (all_at_most(old, 0)) return T{};
  RowLanes<T> row(T(), block, k, bodies.velocities);
  const V3<T> n = row.get3(kNormal);
  const T mass = row.get(kNormalMass),
          p_n = if_at_most(old, T{}, old, at_least_zero(old - dot(n, row.velocity()) * mass));
  row.apply_normal(n, p_n - old);
  row.put(kImpulse, p_n);
  solve_friction(row, n, p_n);
  row.put_velocities(bodies.velocities);
  return (p_n - old) / mass;
}

void relax(RowBlock* blocks, std::size_t count, const SolverBodies& bodies) {
  for_blocks(blocks, count,
             [&](auto lane, RowBlock& block, std::size_t k) RIGOR_LAMBDA { relax_row(lane, block, k, bodies); });
}

void relax_some(RowBlock* blocks, const std::int32_t* rows, std::size_t count, const SolverBodies& bodies,
                const SolverParameters& parameters) {
  solve_until_they_agree(blocks, rows, count, bodies, parameters, [&](RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    return relax_row(double(), block, k, bodies);
  });
}
