// The drift of moser_veselov.cpp; its equation, solved by Newton's method for several bodies at once. Included once by
// each kernels_*.cpp, on purpose without a guard.

inline constexpr int kMostMoserVeselovIterations = 50;
inline constexpr double kLastMoserVeselovCorrection = 1e-9;  // relative; Newton's next correction is about its square

template <class T>
struct MoserVeselovTry {
  V3<T> correction;
  T determinant;  // of the derivative: positive on the branch that begins at f = 0, zero where it ends
};

// One step of Newton's method for  2 (J f + f x J f) = (1 + |f|²) a.
template <class T>
RIGOR_INLINE MoserVeselovTry<T> moser_veselov_try(const Bodies& b, std::size_t i, V3<T> f, V3<T> a) {
  const T two = broadcast(T(), 2), zero = T{};
  const Symmetric<T> J = symmetric(T(), b, kInertia, i);
  const V3<T> Jf = J * f;
  const V3<T> residual = two * (Jf + cross(f, Jf)) - (broadcast(T(), 1) + dot(f, f)) * a;
  // 2 (J + [f]x J - [J f]x - a fᵀ), by columns
  const V3<T> Jx = {J.xx, J.xy, J.xz}, Jy = {J.xy, J.yy, J.yz}, Jz = {J.xz, J.yz, J.zz};
  const V3<T> x = two * (Jx + cross(f, Jx) - V3<T>{zero, Jf.z, zero - Jf.y} - f.x * a);
  const V3<T> y = two * (Jy + cross(f, Jy) - V3<T>{zero - Jf.z, zero, Jf.x} - f.y * a);
  const V3<T> z = two * (Jz + cross(f, Jz) - V3<T>{Jf.y, zero - Jf.x, zero} - f.z * a);
  const V3<T> yz = cross(y, z);
  const T determinant = dot(x, yz);
  const V3<T> solved = {dot(residual, yz), dot(residual, cross(z, x)), dot(residual, cross(x, y))};
  return {(broadcast(T(), 1) / determinant) * solved, determinant};
}

// Improves f from a guess to the solution. In lanes without a solution f keeps the guess and `solved` stays zero.
template <class T>
RIGOR_INLINE void solve_moser_veselov(const Bodies& b, std::size_t i, V3<T> a, V3<T>& f, T& solved) {
  const V3<T> guess = f;
  const T one = broadcast(T(), 1), zero = T{};
  T active = one;
  solved = zero;
  for (int n = 0; n < kMostMoserVeselovIterations && !all_at_most(active, 0); ++n) {
    const MoserVeselovTry<T> tried = moser_veselov_try(b, i, f, a);
    const V3<T> c = tried.correction, next = f - c;
    const T size = square_root(dot(c, c));
    const T last = broadcast(T(), kLastMoserVeselovCorrection) * (one + square_root(dot(next, next)));
    const T still = active;  // lanes that have arrived stay where they are
    f = {if_at_most(still, zero, f.x, next.x), if_at_most(still, zero, f.y, next.y),
         if_at_most(still, zero, f.z, next.z)};
    const T on_branch = if_at_most(tried.determinant, zero, zero, one);
    solved = if_at_most(still, zero, solved, if_at_most(size, last, on_branch, zero));
    // What is not a number is not at most anything: such a lane has failed.
    active = if_at_most(size, last, zero, if_at_most(size, broadcast(T(), __builtin_huge_val()), active, zero));
  }
  f = {if_at_most(solved, zero, guess.x, f.x), if_at_most(solved, zero, guess.y, f.y),
       if_at_most(solved, zero, guess.z, f.z)};
}

bool moser_veselov_drift(const Bodies& b, double* state, const double* carried, double dt) {
  bool all_solved = true;
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const T h = broadcast(T(), dt), one = broadcast(T(), 1);
    const Q4<T> q = get4(T(), state, b, kOrientation, i);
    const V3<T> L_B = transposed_times(matrix_of(q), get3(T(), carried, b, kMomentum, i));
    V3<T> f = broadcast(T(), 0.5 * dt) * times_inertia(b, kInverseInertia, i, L_B);
    T solved;
    solve_moser_veselov(b, i, h * L_B, f, solved);
    all_solved &= all_at_most(get(T(), b.constants, b, kMoves, i) - solved, 0);
    put3(state, b, kPosition, i, get3(T(), state, b, kPosition, i) + h * get3(T(), state, b, kVelocity, i));
    put4(state, b, kOrientation, i, normalised(q * Q4<T>{one, f.x, f.y, f.z}));
  });
  return all_solved;
}
