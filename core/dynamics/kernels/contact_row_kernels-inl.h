// Points of piles, several at once; kernels.h says what comes out, contact/pile_solver.h has the law. Included once by
// each kernels_*.cpp, on purpose without a guard.

template <class T>
RIGOR_INLINE T at_least_zero(T x) {
  return if_at_most(x, T{}, T{}, x);
}

// As many rows of a block as T has lanes, from its k-th on, with their two bodies.
template <class T>
struct RowPair {
  RowBlock& block;
  std::size_t k;
  Twist<T> a, b;

  RIGOR_INLINE RowPair(T, RowBlock& of, std::size_t at, const double* records)
      : block(of),
        k(at),
        a(twist_of(get_record(T(), records, of.a + at))),
        b(twist_of(get_record(T(), records, of.b + at))) {}

  RIGOR_INLINE T get(int column) const { return load(T(), block.columns[column] + k); }
  RIGOR_INLINE V3<T> get3(int column) const { return {get(column), get(column + 1), get(column + 2)}; }
  RIGOR_INLINE void put(int column, T x) const { store(block.columns[column] + k, x); }

  // Of the points of `a` against those of `b`.
  RIGOR_INLINE V3<T> velocity() const { return (a.v + cross(a.w, get3(kArmA))) - (b.v + cross(b.w, get3(kArmB))); }
  RIGOR_INLINE void push_normal(V3<T> n, T p) {
    a.v = a.v + (get(kInverseMassA) * p) * n, a.w = a.w + p * get3(kSpinA);
    b.v = b.v - (get(kInverseMassB) * p) * n, b.w = b.w - p * get3(kSpinB);
  }
  RIGOR_INLINE void push_tangential(V3<T> t, V3<T> s, T p_t, T p_s) {
    const V3<T> p = p_t * t + p_s * s;
    a.v = a.v + get(kInverseMassA) * p, a.w = a.w + (p_t * get3(kSpinA + 3) + p_s * get3(kSpinA + 6));
    b.v = b.v - get(kInverseMassB) * p, b.w = b.w - (p_t * get3(kSpinB + 3) + p_s * get3(kSpinB + 6));
  }
  RIGOR_INLINE void put_motions(double* records) const {
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
struct Spun {
  V3<T> n, t, s;
};
// What unit impulses at the end of an arm add to w.
template <class T>
RIGOR_INLINE Spun<T> spun(const Record<T>& inertia, V3<T> arm, V3<T> n, V3<T> t, V3<T> s) {
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

void prepare_rows(RowBlock* blocks, std::size_t count, const PileRecords& of) {
  for_blocks(blocks, count, [&](auto lane, RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    using T = decltype(lane);
    const RowPair<T> row(T(), block, k, of.motions);
    const auto put3_row = [&](int column, V3<T> x) RIGOR_LAMBDA {
      row.put(column, x.x), row.put(column + 1, x.y), row.put(column + 2, x.z);
    };
    const V3<T> n = row.get3(kNormal), t = tangent_of(n), s = cross(n, t), arm_a = row.get3(kArmA),
                arm_b = row.get3(kArmB);
    const V3<T> friction = row.get3(kSpinA);
    row.put(kImpulse + 1, dot(t, friction)), row.put(kImpulse + 2, dot(s, friction));
    put3_row(kTangent, t);
    const Record<T> inertia_a = get_record(T(), of.inertias, block.a + k),
                    inertia_b = get_record(T(), of.inertias, block.b + k);
    const T mass_a = inertia_a.c[6], mass_b = inertia_b.c[6];
    const Spun<T> spin_a = spun(inertia_a, arm_a, n, t, s), spin_b = spun(inertia_b, arm_b, n, t, s);
    put3_row(kSpinA, spin_a.n), put3_row(kSpinA + 3, spin_a.t), put3_row(kSpinA + 6, spin_a.s);
    put3_row(kSpinB, spin_b.n), put3_row(kSpinB + 3, spin_b.t), put3_row(kSpinB + 6, spin_b.s);
    row.put(kInverseMassA, mass_a), row.put(kInverseMassB, mass_b);
    // What a unit impulse along one direction gives along another: (arm x d) · spin = d · (spin x arm).
    const auto give = [&](V3<T> d, V3<T> a, V3<T> b)
                          RIGOR_LAMBDA { return dot(d, cross(a, arm_a)) + dot(d, cross(b, arm_b)); };
    const T free = mass_a + mass_b, one = broadcast(T(), 1), half = broadcast(T(), 0.5);
    const T nn = free + give(n, spin_a.n, spin_b.n), tt = free + give(t, spin_a.t, spin_b.t),
            ss = free + give(s, spin_a.s, spin_b.s), ts = give(s, spin_a.t, spin_b.t);
    const T inverse = one / (tt * ss - ts * ts), apart = half * (tt - ss);
    row.put(kPaceNormal, one / nn);
    row.put(kPaceStick, ss * inverse), row.put(kPaceStick + 1, tt * inverse);
    row.put(kPaceStick + 2, T{} - ts * inverse);
    row.put(kPaceSlip, one / (half * (tt + ss) + square_root(apart * apart + ts * ts)));
  });
}

std::size_t measure_gaps(RowBlock* blocks, std::size_t count, const PileRecords& of, const PileLaw& law,
                         std::int32_t* hits) {
  std::size_t found = 0;
  for_blocks(blocks, count, [&](auto lane, RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    using T = decltype(lane);
    const RowPair<T> row(T(), block, k, of.motions), change(T(), block, k, of.changes);
    const V3<T> n = row.get3(kNormal);
    const T gap = row.get(kGap) + dot(n, change.velocity());
    const T approach = T{} - dot(n, row.velocity());
    row.put(kGapNow, gap), row.put(kApproach, approach);
    const T push = broadcast(T(), law.push_rate) * gap, fastest = broadcast(T(), -law.fastest_push);
    // The gap closes by h (share u' + (1 - share) u), of which only the velocity after, u', can be chosen.
    const T closing =
        broadcast(T(), 1 / (law.h * law.share)) * gap - broadcast(T(), (1 - law.share) / law.share) * approach;
    row.put(kBias, if_at_most(T{}, gap, closing, if_at_most(push, fastest, fastest, push)));
    if (all_at_most(approach, law.rest_speed)) [[likely]]
      return;
    for (std::size_t j = k; j < k + width_of(T()); ++j) {
      // It meets in this sub-step, if it hardly speeds up.
      const double u = block.columns[kApproach][j];
      if (u > law.rest_speed && block.columns[kGapNow][j] < 2 * law.h * u)
        hits[found++] = static_cast<std::int32_t>(static_cast<std::size_t>(&block - blocks) * kRowsPerBlock + j);
    }
  });
  return found;
}

void push_rows(RowBlock* blocks, std::size_t count, const PileRecords& of) {
  for_blocks(blocks, count, [&](auto lane, RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    using T = decltype(lane);
    if (all_at_most(load(T(), block.columns[kImpulse] + k), 0)) return;
    RowPair<T> row(T(), block, k, of.motions);
    const V3<T> n = row.get3(kNormal), t = row.get3(kTangent);
    row.push_normal(n, row.get(kImpulse));
    row.push_tangential(t, cross(n, t), row.get(kImpulse + 1), row.get(kImpulse + 2));
    row.put_motions(of.motions);
  });
}

// Coulomb's disc of the normal impulse p_n.
template <class T>
RIGOR_INLINE void solve_friction(RowPair<T>& row, V3<T> n, T p_n) {
  const V3<T> t = row.get3(kTangent), s = cross(n, t), u = row.velocity();
  const T slip_t = dot(t, u), slip_s = dot(s, u), old_t = row.get(kImpulse + 1), old_s = row.get(kImpulse + 2);
  const T radius = if_at_most(p_n, T{}, T{}, row.get(kFriction) * p_n), radius2 = radius * radius;  // may be infinite
  // What would stop it.
  const T cross_pace = row.get(kPaceStick + 2);
  T p_t = old_t - (row.get(kPaceStick) * slip_t + cross_pace * slip_s);
  T p_s = old_s - (cross_pace * slip_t + row.get(kPaceStick + 1) * slip_s);
  const T stick2 = p_t * p_t + p_s * p_s;
  if (!all_at_most(stick2 - radius2, 0)) {
    // On the rim the impulse must look straight against the slip, which only a step of one pace for all directions
    // ends in.
    const T pace = row.get(kPaceSlip), x = old_t - pace * slip_t, y = old_s - pace * slip_s, slip2 = x * x + y * y;
    const T onto = if_at_most(slip2, radius2, broadcast(T(), 1), radius / square_root(slip2));
    p_t = if_at_most(stick2, radius2, p_t, onto * x), p_s = if_at_most(stick2, radius2, p_s, onto * y);
  }
  row.push_tangential(t, s, p_t - old_t, p_s - old_s);
  row.put(kImpulse + 1, p_t), row.put(kImpulse + 2, p_s);
}

// Returns by how much the impulse changes the velocity along the normal.
template <class T>
RIGOR_INLINE T solve_with_bias(T, RowBlock& block, std::size_t k, const PileRecords& of, const PileLaw& law) {
  RowPair<T> row(T(), block, k, of.motions);
  const V3<T> n = row.get3(kNormal);
  const T gap = row.get(kGapNow), old = row.get(kImpulse), pace = row.get(kPaceNormal);
  const T mass_share = if_at_most(T{}, gap, broadcast(T(), 1), broadcast(T(), law.mass_share));
  const T impulse_share = if_at_most(T{}, gap, T{}, broadcast(T(), law.impulse_share));
  const T wanted = T{} - mass_share * ((dot(n, row.velocity()) + row.get(kBias)) * pace) - impulse_share * old;
  const T p_n = at_least_zero(old + wanted);
  if (all_at_most(old, 0) && all_at_most(p_n, 0)) return T{};
  row.push_normal(n, p_n - old);
  row.put(kImpulse, p_n);
  solve_friction(row, n, p_n);
  row.put_motions(of.motions);
  return (p_n - old) / pace;
}

void solve_rows_with_bias(RowBlock* blocks, std::size_t count, const PileRecords& of, const PileLaw& law) {
  for_blocks(blocks, count,
             [&](auto lane, RowBlock& block, std::size_t k) RIGOR_LAMBDA { solve_with_bias(lane, block, k, of, law); });
}

// Calls solve(block, k) for each hit, and up to so many times over for those of bodies that the turn before, or this
// one, has changed by more than `settled`.
template <class F>
RIGOR_INLINE void settle_hits(RowBlock* blocks, const std::int32_t* hits, std::size_t count, const PileRecords& of,
                              const PileLaw& law, F solve) {
  for (std::size_t i = 0; i < count; ++i) {
    const RowBlock& block = blocks[hits[i] / kRowsPerBlock];
    of.stirred[block.a[hits[i] % kRowsPerBlock]] = of.stirred[block.b[hits[i] % kRowsPerBlock]] = 0;
  }
  bool is_settled = count == 0;
  for (int turn = 0; turn < law.most_turns && !is_settled; ++turn) {
    is_settled = true;
    for (std::size_t i = 0; i < count; ++i) {
      RowBlock& block = blocks[hits[i] / kRowsPerBlock];
      const std::size_t k = hits[i] % kRowsPerBlock;
      if (of.stirred[block.a[k]] < turn - 1 && of.stirred[block.b[k]] < turn - 1) continue;
      const double change = solve(block, k);
      if (change * change <= law.settled * law.settled) continue;
      // What is written of a body that does not move is not what is read.
      of.stirred[block.to_a[k]] = of.stirred[block.to_b[k]] = turn;
      is_settled = false;
    }
  }
}

void settle_hits_with_bias(RowBlock* blocks, const std::int32_t* hits, std::size_t count, const PileRecords& of,
                           const PileLaw& law) {
  settle_hits(blocks, hits, count, of, law, [&](RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    return solve_with_bias(double(), block, k, of, law);
  });
}

void solve_rows(RowBlock* blocks, std::size_t count, const PileRecords& of) {
  for_blocks(blocks, count, [&](auto lane, RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    using T = decltype(lane);
    const T old = load(T(), block.columns[kImpulse] + k);
    if (all_at_most(old, 0)) return;
    RowPair<T> row(T(), block, k, of.motions);
    const V3<T> n = row.get3(kNormal);
    const T p_n = if_at_most(old, T{}, old, at_least_zero(old - dot(n, row.velocity()) * row.get(kPaceNormal)));
    row.push_normal(n, p_n - old);
    row.put(kImpulse, p_n);
    solve_friction(row, n, p_n);
    row.put_motions(of.motions);
  });
}

void settle_rebounds(RowBlock* blocks, const std::int32_t* hits, std::size_t count, const PileRecords& of,
                     const PileLaw& law) {
  settle_hits(blocks, hits, count, of, law, [&](RowBlock& block, std::size_t k) RIGOR_LAMBDA {
    const double restitution = block.columns[kRestitution][k], old = block.columns[kImpulse][k];
    if (restitution == 0 || old == 0) return 0.0;
    RowPair<double> row(double(), block, k, of.motions);
    const V3<double> n = row.get3(kNormal);
    const double wanted = (restitution * row.get(kApproach) - dot(n, row.velocity())) * row.get(kPaceNormal);
    const double p_n = at_least_zero(old + wanted);
    row.push_normal(n, p_n - old);
    row.put(kImpulse, p_n);
    solve_friction(row, n, p_n);
    row.put_motions(of.motions);
    return (p_n - old) / row.get(kPaceNormal);
  });
}
