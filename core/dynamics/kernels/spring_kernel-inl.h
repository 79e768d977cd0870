// Springs, several at once. kernels.h describes the results, loads.cpp the law. Each kernels_*.cpp includes this file
// once; it has no guard on purpose.

template <class T>
struct SpringEnd {
  V3<T> arm, position, velocity;  // as PointMotion
};

template <class T>
RIGOR_INLINE V3<T> gather3(T, const double* state, std::size_t stride, int column, const std::int32_t* rows) {
  const double* p = state + static_cast<std::size_t>(column) * stride;
  return {gather(T(), p, rows), gather(T(), p + stride, rows), gather(T(), p + 2 * stride, rows)};
}

// `moves` is 0 at an end that is fixed in the world, where `point` is the point itself.
template <class T>
RIGOR_INLINE SpringEnd<T> spring_end(const Springs& s, const double* state, std::size_t stride,
                                     const std::int32_t* rows, V3<T> point, T moves) {
  const auto pick = [&](V3<T> body, V3<T> world) RIGOR_LAMBDA {
    return V3<T>{if_at_most(moves, T{}, world.x, body.x), if_at_most(moves, T{}, world.y, body.y),
                 if_at_most(moves, T{}, world.z, body.z)};
  };
  const double* q_w = state + kOrientation * stride;
  const V3<T> u = gather3(T(), state, stride, kOrientation + 1, rows);
  const V3<T> zero = {T{}, T{}, T{}};
  SpringEnd<T> end;
  end.arm = rotated(Q4<T>{gather(T(), q_w, rows), u.x, u.y, u.z}, point);
  end.position = pick(gather3(T(), state, stride, kPosition, rows) + end.arm, point);
  end.velocity = zero;
  if (s.damped) {
    const V3<T> v = gather3(T(), state, stride, kVelocity, rows);
    end.velocity = pick(v + cross(gather3(T(), state, stride, kAngularVelocity, rows), end.arm), zero);
  }
  return end;
}

void springs(const Springs& s, const double* state, std::size_t stride, double* pulls) {
  for_rows(
      s.begin, s.end,
      [&](auto lane, std::size_t i) RIGOR_LAMBDA {
        using T = decltype(lane);
        const auto constant = [&](int c) RIGOR_LAMBDA {
          return load(T(), s.constants + static_cast<std::size_t>(c) * s.stride + i);
        };
        const auto point = [&](int c) RIGOR_LAMBDA { return V3<T>{constant(c), constant(c + 1), constant(c + 2)}; };
        const SpringEnd<T> a = spring_end(s, state, stride, s.a + i, point(kPointA), constant(kAMoves));
        const SpringEnd<T> b = spring_end(s, state, stride, s.b + i, point(kPointB), constant(kBMoves));
        const V3<T> line = b.position - a.position;
        const T length = square_root(dot(line, line));
        // If the points coincide, the line has no direction, and the spring no force.
        const V3<T> n = if_at_most(length, T{}, T{}, broadcast(T(), 1) / length) * line;
        const T extension = length - constant(kRestLength);
        T stiffness = constant(kStiffness);
        if (s.quadratic)
          stiffness = stiffness + constant(kQuadratic) * if_at_most(extension, T{}, T{} - extension, extension);
        T tension = stiffness * extension;
        if (s.damped) tension = tension + constant(kDamping) * dot(n, b.velocity - a.velocity);
        const V3<T> force = (T{} - tension) * n;
        const auto put = [&](int c, V3<T> x) RIGOR_LAMBDA {
          double* p = pulls + static_cast<std::size_t>(c) * s.stride + i;
          store(p, x.x), store(p + s.stride, x.y), store(p + 2 * s.stride, x.z);
        };
        put(kPull, force);
        put(kTorqueA, cross(force, a.arm));
        put(kTorqueB, cross(b.arm, force));
      },
      kFewSprings);
}
