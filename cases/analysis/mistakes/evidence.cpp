#include "cases/analysis/mistakes/evidence.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace rigor::inline analysis {
namespace {

constexpr std::size_t kTurn = 3, kSpeed = 12, kSpin = 15;  // where the groups begin
constexpr double kOfLoading = 1e-12;                       // roundings of a few conversions

// The largest norm of the columns from `first` to `last`, or of their change since the start if `is_change`.
double largest(const Sight& base, std::size_t bodies, std::size_t first, std::size_t last, bool is_change) {
  const std::size_t row = kMotionColumns, sample = bodies * row;
  double most = 0;
  for (std::size_t at = 0; at + row <= base.states.size(); at += row) {
    double square = 0;
    for (std::size_t c = first; c < last; ++c) {
      const double start = is_change ? base.states[at % sample + c] : 0;
      square += std::pow(base.states[at + c] - start, 2);
    }
    most = std::max(most, square);
  }
  return std::sqrt(most);
}

// The range of a part among `size` numbers, with `sample` numbers at each instant.
std::pair<std::size_t, std::size_t> range_of(Observation::Part part, std::size_t sample, std::size_t size) {
  const std::size_t samples = size / sample, middle = (samples + 1) / 2;
  switch (part) {
    case Observation::Part::loaded:
      return {0, std::min(sample, size)};
    case Observation::Part::early:
      return {std::min(sample, size), std::max(sample * middle, std::min(sample, size))};
    case Observation::Part::late:
      return {sample * middle, size};
    case Observation::Part::end:
      return {size - std::min(sample, size), size};
  }
  return {0, 0};
}

}  // namespace

Observation::Observation(const View& view, std::size_t view_index, Part part, const Sight& base, std::size_t bodies)
    : view_(view_index), part_(part), base_(base), sample_(bodies * kMotionColumns) {
  std::tie(begin_, end_) = range_of(part, sample_, base.states.size());
  per_ = std::max<double>(1, static_cast<double>(end_ - begin_) / kMotionColumns);
  tolerance_ = is_loaded() ? kOfLoading : view.tolerance;
  // A body that hardly moves gets a metre, and a metre in the view's duration, as its scales.
  constexpr double kHardly = 1e-3;
  const double dt = view.dt.front(), time = dt * static_cast<double>(view.steps);
  const double way = largest(base, bodies, 0, kTurn, true), length = way > kHardly ? way : 1;
  const double fastest = largest(base, bodies, kSpeed, kSpin, false), speed = std::max(fastest, length / time);
  // An engine may meet an impact a step late. An error must be four times the path of a step to count.
  if (view.can_touch && !is_loaded()) tolerance_ = std::max(tolerance_, 4 * dt * fastest / length);
  const double spin = std::max(largest(base, bodies, kSpin, kMotionColumns, false), 1 / time);
  for (std::size_t c = 0; c < kMotionColumns; ++c)
    weights_[c] = c < kTurn ? 1 / length : c < kSpeed ? 1 : c < kSpin ? 1 / speed : 1 / spin;
}

double Observation::weight(std::size_t i) const { return weights_[i % kMotionColumns]; }

Distances Observation::distances(const Sight& engine, const Sight& mistake) const {
  Distances sums;
  const std::size_t shorter = std::min(engine.states.size(), mistake.states.size()), end = std::min(end_, shorter);
  for (std::size_t i = begin_; i < end; ++i) {
    const double e = weight(i) * (engine.states[i] - base_.states[i]),
                 f = weight(i) * (mistake.states[i] - base_.states[i]);
    sums.error += e * e, sums.predicted += f * f, sums.rest += (e - f) * (e - f), sums.together += e * f;
  }
  const bool is_cut = shorter < end_ && engine.states.size() != mistake.states.size();
  return {std::sqrt(sums.error / per_), std::sqrt(sums.predicted / per_), std::sqrt(sums.rest / per_),
          sums.together / per_, !is_cut};
}

double Observation::uncertainty(const Sight& sight) const {
  double sum = 0;
  for (std::size_t i = begin_; i < std::min({end_, sight.coarse.size(), sight.states.size()}); ++i)
    sum += std::pow(weight(i) * (sight.states[i] - sight.coarse[i]), 2);
  return std::sqrt(sum / per_);
}

Observation Observation::until_lost(const Sight& engine) const {
  constexpr double kManyTimes = 10, kUnsure = 0.03;
  Observation kept = *this;
  const std::size_t size = std::min(base_.states.size(), engine.states.size());
  const bool blows_up = engine.states.size() < base_.states.size();
  for (std::size_t at = sample_; sample_ > 0 && at + sample_ <= size; at += sample_) {
    double away = 0, open = 0;
    for (std::size_t i = at; i < at + sample_; ++i) {
      away += std::pow(weight(i) * (engine.states[i] - base_.states[i]), 2);
      if (i < engine.coarse.size()) open += std::pow(weight(i) * (engine.states[i] - engine.coarse[i]), 2);
    }
    const double bodies = static_cast<double>(sample_) / kMotionColumns;
    if (away < bodies * kManyTimes * kManyTimes) continue;
    if (!blows_up && open < kUnsure * kUnsure * away) continue;
    kept.end_ = std::clamp(at + sample_, begin_, end_);  // that it has left is seen
    kept.per_ = std::max<double>(1, static_cast<double>(kept.end_ - begin_) / kMotionColumns);
    break;
  }
  return kept;
}

std::vector<double> Observation::difference(const Sight& sight) const {
  std::vector<double> out(end_ - begin_, 0.0);
  for (std::size_t i = begin_; i < std::min(end_, sight.states.size()); ++i)
    out[i - begin_] = weight(i) * (sight.states[i] - base_.states[i]) / std::sqrt(per_);
  return out;
}

std::vector<Observation> observations_of(const std::vector<View>& views, const std::vector<Sight>& bases,
                                         const std::vector<ProbeScene>& probes) {
  std::vector<Observation> all;
  for (std::size_t v = 0; v < views.size(); ++v) {
    if (!bases[v].why.empty()) continue;
    using Part = Observation::Part;
    for (const Part part : {Part::loaded, Part::early, Part::late, Part::end}) {
      if (part == Part::end && !views[v].can_touch) continue;
      all.emplace_back(views[v], v, part, bases[v], probes[views[v].probe].scene->bodies.size());
    }
  }
  return all;
}

}  // namespace rigor::inline analysis
