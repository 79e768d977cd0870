// The passes of Adams methods; kernels.h describes them. Each kernels_*.cpp includes this file once; it has no guard on
// purpose.

// The newest rates come last, because they become available last.
void sums_of_older(std::size_t first, std::size_t last, const AdamsRates& r, const AdamsTables& t) {
  for (std::size_t i = first; i < last; i += kWidth) {
    Lane predictor = Lane{}, corrector = Lane{};
    for (std::size_t s = kAdamsRates - 1; s > 0; --s) {
      const Lane rate = load(Lane(), r.rates[s - 1] + i);
      predictor = predictor + broadcast(Lane(), r.predictor[s]) * rate;
      corrector = corrector + broadcast(Lane(), r.corrector[s]) * rate;
    }
    store(t.older_predictor + i, predictor);
    store(t.older_corrector + i, corrector);
  }
}

void adams_advance(const Bodies& b, const AdamsTables& t, const AdamsWeights& weights, const double* wrench,
                   double* rates, AdamsRatesFrom from, bool needs_w) {
  for_rows(b.begin, b.end, [&](auto lane, std::size_t i) RIGOR_LAMBDA {
    using T = decltype(lane);
    Bodies packed = b;
    packed.stride = t.stride;
    const T h = broadcast(T(), t.h), at_end = broadcast(T(), t.h * weights.at_end);
    const bool corrects = from == AdamsRatesFrom::stage;
    Carried<T> now = get_carried(T(), corrects ? t.known : t.y, packed, i), rate = get_carried(T(), rates, packed, i);
    if (from != AdamsRatesFrom::table) {
      rate.L = V3<T>{T{}, T{}, T{}};
      if (wrench) rate.L = get(T(), b.constants, b, kMoves, i) * get3(T(), wrench, b, kTorque, i);
      rate.v = acceleration(T(), b, i, wrench);
    }
    if (corrects) {
      now.v = now.v + at_end * rate.v;
      now.L = now.L + at_end * rate.L;
      const Q4<T> q = get4(T(), t.stage, b, kOrientation, i);
      rate.q = QuaternionChart::rate(b, nullptr, i, q, times_inertia_in_world(b, kInverseInertia, i, q, now.L));
      rate.x = now.v;
      now.x = now.x + at_end * now.v;
      now.q = nearly_unit_normalised(now.q + at_end * rate.q);
      put_carried(t.y, packed, i, now);
    }
    if (from != AdamsRatesFrom::table) put_carried(rates, packed, i, rate);

    const Carried<T> predicted =
        plus(now, h, plus(get_carried(T(), t.older_predictor, packed, i), broadcast(T(), weights.predictor), rate));
    const Carried<T> known =
        plus(now, h, plus(get_carried(T(), t.older_corrector, packed, i), broadcast(T(), weights.corrector), rate));
    const Q4<T> q = nearly_unit_normalised(predicted.q);
    const V3<T> w = times_inertia_in_world(b, kInverseInertia, i, q, predicted.L);
    const Q4<T> there = nearly_unit_normalised(known.q + at_end * QuaternionChart::rate(b, nullptr, i, q, w));
    put_carried(t.known, packed, i, known);
    put3(t.stage, b, kPosition, i, known.x + at_end * predicted.v);
    put4(t.stage, b, kOrientation, i, there);
    if (!needs_w) return;
    put3(t.stage, b, kVelocity, i, predicted.v);
    put3(t.stage, b, kAngularVelocity, i, times_inertia_in_world(b, kInverseInertia, i, there, predicted.L));
  });
}
