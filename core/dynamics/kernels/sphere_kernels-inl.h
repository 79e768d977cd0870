// Searches many spheres, few of which touch anything; kernels.h describes the results. Each kernels_*.cpp includes this
// file once; it has no guard on purpose.

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

// The places of as many pairs as T has lanes; the last pair stands in for those beyond it.
template <class T>
struct PlacesOfPairs {
  std::int32_t first[kRowsPerBlock], second[kRowsPerBlock];

  template <class PairAt>
  RIGOR_INLINE PlacesOfPairs(T, std::size_t i, std::size_t count, PairAt pair_at) {
    for (std::size_t k = 0; k < width_of(T()); ++k) {
      const std::pair<int, int>* pair = pair_at(i + k < count ? i + k : count - 1);
      first[k] = pair->first, second[k] = pair->second;
    }
  }
};
template <class T>
RIGOR_INLINE V3<T> centre_in(const Record<T>& place) {
  return {place.c[0], place.c[1], place.c[2]};
}
template <class T>
RIGOR_INLINE V3<T> velocity_in(const Record<T>& place) {
  return {place.c[4], place.c[5], place.c[6]};
}

std::size_t near_pairs(const double* places, const std::pair<int, int>* pairs, std::size_t count, std::int32_t* near) {
  std::size_t found = 0;
  for_rows(0, count, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const PlacesOfPairs<T> at(T(), i, count, [&](std::size_t k) RIGOR_LAMBDA { return pairs + k; });
    const Record<T> a = get_record(T(), places, at.first), b = get_record(T(), places, at.second);
    const V3<T> line = centre_in(a) - centre_in(b);
    const T reach = a.c[3] + b.c[3], reach2 = reach * reach, distance2 = dot(line, line), one = broadcast(T(), 1);
    double are_near[width_of(T())];  // so are those of which it is not known
    store(are_near, if_at_most(distance2, reach2, one, if_at_most(reach2, distance2, T{}, one)));
    for (std::size_t k = 0; k < width_of(T()) && i + k < count; ++k) {
      near[found] = static_cast<std::int32_t>(i + k);
      found += are_near[k] != 0;
    }
  });
  return found;
}

void ball_contacts(const double* places, const std::pair<int, int>* pairs, const std::int32_t* near, std::size_t count,
                   double dt, double margin_of_size, BallContacts* contacts) {
  for_rows(0, count, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    const PlacesOfPairs<T> at(T(), i, count, [&](std::size_t k) RIGOR_LAMBDA { return pairs + near[k]; });
    const Record<T> a = get_record(T(), places, at.first), b = get_record(T(), places, at.second);
    const V3<T> v = velocity_in(a) - velocity_in(b), line = centre_in(a) - centre_in(b);
    const T zero = T{}, step = broadcast(T(), dt), size = if_at_most(a.c[7], b.c[7], a.c[7], b.c[7]),
            margin = broadcast(T(), margin_of_size) * size, touching = a.c[7] + b.c[7];
    const T distance = square_root(dot(line, line)), speed = (zero - dot(line, v)) / distance,
            gap = distance - touching;
    // A fast ball touches along another normal than the one at its present nearest point.
    const T meets = if_at_most(gap, zero, zero, if_at_most(step * speed, gap, zero, gap / speed));
    const T moves = square_root(dot(v, v)) * meets, ahead = if_at_most(moves, margin, zero, meets);
    const V3<T> there = line + ahead * v;
    const T apart = square_root(dot(there, there)), left = apart - touching;
    const V3<T> n = (broadcast(T(), 1) / apart) * there;
    const T u = dot(n, v), gap_there = left - ahead * u, most = margin + if_at_most(u, zero, zero - step * u, zero);
    BallContacts& out = contacts[i / kRowsPerBlock];
    const std::size_t k = i % kRowsPerBlock;
    store(out.normal[0] + k, n.x), store(out.normal[1] + k, n.y), store(out.normal[2] + k, n.z);
    store(out.gap + k, gap_there);
    store(out.overlap + k, if_at_most(ahead, zero, if_at_most(left, zero, left, zero), left));
    store(out.excess + k, gap_there - most);
  });
}
