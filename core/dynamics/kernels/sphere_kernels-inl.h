// Looking through many spheres, of which few have met anything; kernels.h says what comes out. Included once by each
// kernels_*.cpp, on purpose without a guard.

bool have_stayed(const Bodies& b, const double* state, const double* spheres, const double* slack) {
  bool stayed = true;
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const V3<T> moved = get3(T(), state, b, kPosition, i) - get3(T(), spheres, b, kFoundAt, i);
    const T radius = get(T(), spheres, b, kRadius, i);
    const auto within = [&](T d, double most)
                            RIGOR_LAMBDA { return all_at_most(if_at_most(radius, T{}, T{}, d * d), most * most); };
    stayed = stayed && within(moved.x, slack[0]) && within(moved.y, slack[1]) && within(moved.z, slack[2]);
  });
  return stayed;
}

std::size_t below_plane(const Bodies& b, const double* state, const double* spheres, const double* plane,
                        std::int32_t* rows) {
  std::size_t count = 0;
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const V3<T> normal = {broadcast(T(), plane[0]), broadcast(T(), plane[1]), broadcast(T(), plane[2])};
    const T gap =
        dot(normal, get3(T(), state, b, kPosition, i)) - broadcast(T(), plane[3]) - get(T(), spheres, b, kRadius, i);
    if (all_at_most(T{} - gap, 0)) [[likely]]
      return;
    double gaps[sizeof(T) / sizeof(double)];
    store(gaps, gap);
    for (std::size_t k = 0; k < sizeof(T) / sizeof(double); ++k) {
      if (gaps[k] < 0) rows[count++] = static_cast<std::int32_t>(i + k);
    }
  });
  return count;
}
