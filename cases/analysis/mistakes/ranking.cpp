#include "cases/analysis/mistakes/ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace rigor::inline analysis {
namespace {

// A few roundings in single precision, and some hundred steps of them.
constexpr double kSingleLoaded = 1e-6, kSingleMoved = 1e-4;

// An observation counts if its error is this many times what the nearest mistake leaves there. Otherwise the error is
// treated as a difference between the schemes.
constexpr double kClear = 20;
// About 140 pairs are tried. In two numbers, such as the position and speed of a sliding body, one of them fits by
// chance. It fits to a twentieth once in three times, and to this share once in a hundred times.
constexpr double kClearOfPair = 120;

// A pair of mistakes must leave at most half of the rest of a single one. It must leave at most a tenth if the single
// one explains enough: extrapolation leaves up to a fiftieth of the error of smooth motion (views.cpp).
constexpr double kDoes = 0.98, kWorthASecond = 0.5, kWorthASecondThen = 0.1;

constexpr double kExplained = 0.01;  // the largest rest of an explained error

double share_left(const Distances& d) {
  const double size = std::max(d.error, d.predicted);
  const double share = d.rest / size;
  return d.ends_alike && std::isfinite(share) ? std::min(1.0, share) : 1;
}

}  // namespace

Trace::Trace(const std::vector<View>& views, const std::vector<Observation>& observations, std::vector<Sight> engine,
             bool is_single)
    : views_(views), engine_(std::move(engine)), is_single_(is_single) {
  for (const Observation& observation : observations) {
    observations_.push_back(observation.until_lost(engine_[observation.view_index()]));
    if (observations_.back().is_empty()) observations_.pop_back();
  }
}

bool Trace::is_seen(std::size_t o) const { return engine_[observations_[o].view_index()].why.empty(); }

bool Trace::is_seen(std::size_t o, const Hypothesis& hypothesis) const {
  const Sight& sight = hypothesis.sights[observations_[o].view_index()];
  return is_seen(o) && sight.why.empty() && (observations_[o].is_loaded() || !sight.as_loaded_alone);
}

double Trace::tolerance(std::size_t o) const {
  const Observation& observation = observations_[o];
  const double of_precision = !is_single_ ? 0 : observation.is_loaded() ? kSingleLoaded : kSingleMoved;
  // The two finest steps have a larger error than all three together, so a share of it is a bound.
  constexpr double kSome = 0.3;
  const double of_steps = kSome * observation.uncertainty(engine_[observation.view_index()]);
  return std::max({observation.tolerance(), of_precision, of_steps});
}

double Trace::certain_error(std::size_t o) const {
  const View& view = views_[observations_[o].view_index()];
  if (observations_[o].is_loaded() || view.kind == View::Kind::twin) return tolerance(o);
  if (view.kind == View::Kind::same_method) return std::numeric_limits<double>::infinity();
  // Smooth motion: some uncertainties. If bodies touch, contact models differ without any mistake: ODE's box on a slope
  // where it hardly slides is wrong by 0.045 of its path.
  constexpr double kFew = 10, kFarOff = 0.1;
  return view.kind == View::Kind::extrapolated ? kFew * tolerance(o) : kFarOff;
}

std::vector<double> Trace::nearest(const std::vector<Hypothesis>& hypotheses) const {
  std::vector<double> least(observations_.size(), 0);
  for (std::size_t o = 0; o < observations_.size(); ++o) {
    if (!is_seen(o)) continue;
    const std::size_t v = observations_[o].view_index();
    least[o] = observations_[o].distances(engine_[v], engine_[v]).error;
    for (const Hypothesis& hypothesis : hypotheses) {
      if (!is_seen(o, hypothesis)) continue;
      const Distances d = observations_[o].distances(engine_[v], hypothesis.sights[v]);
      const double rest = d.rest * (hypothesis.names.size() > 1 ? kClearOfPair / kClear : 1);
      if (d.ends_alike) least[o] = std::min(least[o], rest);
    }
  }
  return least;
}

bool Trace::is_clear(std::size_t o, double size, double nearest) const {
  return size > std::max(tolerance(o), kClear * nearest);
}

bool Trace::is_active(std::size_t o, double size, double error, double nearest) const {
  const bool is_accurate = views_[observations_[o].view_index()].kind == View::Kind::accurate;
  return is_clear(o, size, nearest) || (!is_accurate && error > certain_error(o));
}

// An observation beside the accurate core weighs less, because the engine's contact model has a share in it. An
// observation with an error near the uncertainty of extrapolation weighs little.
double Trace::weight_of(std::size_t o, double size, const Sight& mistake) const {
  constexpr double kOfAccurate = 0.25, kSeen = 0.03;
  const Observation& observation = observations_[o];
  if (observation.is_loaded()) return 1;
  if (views_[observation.view_index()].kind == View::Kind::accurate) return kOfAccurate;
  const double open =
      std::hypot(observation.uncertainty(engine_[observation.view_index()]), observation.uncertainty(mistake));
  const double blur = open / (kSeen * size);
  return std::isfinite(blur) ? 1 / (1 + blur * blur) : 0;
}

std::vector<std::size_t> Trace::probes_off(const std::vector<Hypothesis>& hypotheses) const {
  const std::vector<double> least = nearest(hypotheses);
  std::vector<std::size_t> off;
  for (std::size_t o = 0; o < observations_.size(); ++o) {
    if (!is_seen(o)) continue;
    const Sight& engine = engine_[observations_[o].view_index()];
    const double error = observations_[o].distances(engine, engine).error;
    const std::size_t probe = views_[observations_[o].view_index()].probe;
    const bool is_off = is_clear(o, error, least[o]) || error > certain_error(o);
    if (is_off && (off.empty() || off.back() != probe)) off.push_back(probe);
  }
  return off;
}

double Trace::left_by(const Hypothesis& mistake, const Hypothesis& seen_with, const std::vector<double>& least,
                      std::map<std::size_t, CaseShare>* cases) const {
  double squares = 0, count = 0;
  for (std::size_t o = 0; o < observations_.size(); ++o) {
    const std::size_t v = observations_[o].view_index();
    if (!is_seen(o, mistake) || !is_seen(o, seen_with)) continue;
    const Distances d = observations_[o].distances(engine_[v], mistake.sights[v]);
    if (!is_active(o, std::max(d.error, d.predicted), d.error, least[o])) continue;
    const double left = share_left(d);
    const double weight = weight_of(o, std::max(d.error, d.predicted), mistake.sights[v]);
    squares += weight * left * left, count += weight;
    if (!cases || !is_active(o, d.error, d.error, least[o])) continue;
    CaseShare& share = (*cases)[views_[v].probe];
    share.error = std::max(share.error, d.error), share.rest = std::max(share.rest, left);
  }
  return count > 0 ? std::sqrt(squares / count) : 1;
}

std::vector<Suspect> Trace::ranked(const std::vector<Hypothesis>& hypotheses,
                                   const std::vector<ProbeScene>& probes) const {
  const std::vector<double> least = nearest(hypotheses);
  std::vector<Suspect> suspects;
  for (std::size_t h = 0; h < hypotheses.size(); ++h) {
    std::map<std::size_t, CaseShare> cases;  // by probe
    Suspect suspect{h, 1 - left_by(hypotheses[h], hypotheses[h], least, &cases), {}, 0};
    if (cases.empty()) continue;
    for (auto& [probe, share] : cases) {
      share.id = probes[probe].id;
      suspect.explained += share.rest < kExplained;
      suspect.cases.push_back(share);
    }
    suspects.push_back(std::move(suspect));
  }
  std::stable_sort(suspects.begin(), suspects.end(),
                   [](const Suspect& a, const Suspect& b) { return a.explains > b.explains; });
  const auto best_alone = std::find_if(suspects.begin(), suspects.end(), [&](const Suspect& suspect) {
    return hypotheses[suspect.hypothesis].names.size() == 1;
  });
  const Hypothesis* best = best_alone == suspects.end() ? nullptr : &hypotheses[best_alone->hypothesis];
  std::erase_if(suspects, [&](const Suspect& suspect) { return has_idle_second(suspect, hypotheses, best, least); });
  return suspects;
}

bool Trace::has_idle_second(const Suspect& suspect, const std::vector<Hypothesis>& hypotheses, const Hypothesis* best,
                            const std::vector<double>& least) const {
  const Hypothesis& pair = hypotheses[suspect.hypothesis];
  if (pair.names.size() == 1) return false;
  double alone = best ? left_by(*best, pair, least, nullptr) : 1;
  for (const Hypothesis& one : hypotheses) {
    const bool is_of_pair = one.names.size() == 1 && std::ranges::find(pair.names, one.names[0]) != pair.names.end();
    if (is_of_pair) alone = std::min(alone, left_by(one, pair, least, nullptr));
  }
  return 1 - suspect.explains > (1 - alone < kDoes ? kWorthASecond : kWorthASecondThen) * alone;
}

Trace::Fit Trace::fit(const Hypothesis& hypothesis) const {
  // A different contact model would look like an amount, so contacts count only if nothing else does.
  const Fit smooth = fit(hypothesis, false);
  return smooth.cosine == 0 ? fit(hypothesis, true) : smooth;
}

Trace::Fit Trace::fit(const Hypothesis& hypothesis, bool of_contacts) const {
  double together = 0, predicted = 0, error = 0;
  for (std::size_t o = 0; o < observations_.size(); ++o) {
    const std::size_t v = observations_[o].view_index();
    if (!is_seen(o, hypothesis)) continue;
    if (!of_contacts && !observations_[o].is_loaded() && views_[v].kind == View::Kind::accurate) continue;
    const Distances d = observations_[o].distances(engine_[v], hypothesis.sights[v]);
    if (std::max(d.error, d.predicted) < tolerance(o)) continue;
    // Each observation has the same weight.
    const double weight = 1 / (d.error * d.error + d.predicted * d.predicted);
    together += weight * d.together, predicted += weight * d.predicted * d.predicted;
    error += weight * d.error * d.error;
  }
  const Fit fit{together / predicted, together / std::sqrt(predicted * error), !of_contacts};
  return std::isfinite(fit.factor) && std::isfinite(fit.cosine) ? fit : Fit{};
}

std::vector<std::size_t> Trace::explained_by(const Hypothesis& hypothesis, const std::vector<Hypothesis>& all) const {
  const std::vector<double> least = nearest(all);
  std::vector<std::size_t> explained;
  for (std::size_t o = 0; o < observations_.size(); ++o) {
    const std::size_t v = observations_[o].view_index();
    if (!is_seen(o, hypothesis)) continue;
    const Distances d = observations_[o].distances(engine_[v], hypothesis.sights[v]);
    if (is_active(o, d.error, d.error, least[o]) && share_left(d) < kExplained) explained.push_back(o);
  }
  return explained;
}

std::vector<Trace::Sum> Trace::sums(const std::vector<Hypothesis>& hypotheses) const {
  const std::size_t n = hypotheses.size();
  std::vector<double> rest(n * n, 0);
  double count = 0;
  for (std::size_t o = 0; o < observations_.size(); ++o) {
    const std::size_t v = observations_[o].view_index();
    if (!is_seen(o)) continue;
    const double error = observations_[o].distances(engine_[v], engine_[v]).error;
    if (!(error > certain_error(o)) || !std::isfinite(error)) continue;
    ++count;
    std::vector<std::vector<double>> moved(n);
    std::vector<double> e = observations_[o].difference(engine_[v]), left(e.size());
    for (std::size_t h = 0; h < n; ++h) {
      if (is_seen(o, hypotheses[h])) moved[h] = observations_[o].difference(hypotheses[h].sights[v]);
      moved[h].resize(e.size(), 0.0);
    }
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < e.size(); ++k) left[k] = e[k] - moved[i][k];
      for (std::size_t j = i + 1; j < n; ++j) {
        double sum = 0;
        for (std::size_t k = 0; k < e.size(); ++k) sum += (left[k] - moved[j][k]) * (left[k] - moved[j][k]);
        const double share = std::sqrt(sum) / error;
        rest[i * n + j] += std::isfinite(share) ? std::min(1.0, share * share) : 1;
      }
    }
  }
  std::vector<Sum> all;
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 1; j < n; ++j) all.push_back({i, j, std::sqrt(rest[i * n + j] / std::max(1.0, count))});
  }
  std::sort(all.begin(), all.end(), [](const Sum& a, const Sum& b) { return a.rest < b.rest; });
  return all;
}

std::set<std::pair<std::size_t, std::size_t>> Trace::likely_pairs(const std::vector<Hypothesis>& all,
                                                                  const std::vector<ProbeScene>& probes) const {
  constexpr std::size_t kMostTried = 24;
  std::vector<std::pair<std::size_t, std::pair<std::size_t, std::size_t>>> covers;
  std::vector<std::set<std::size_t>> explained;
  for (const Hypothesis& hypothesis : all) {
    const auto own = explained_by(hypothesis, all);
    explained.emplace_back(own.begin(), own.end());
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size() && !explained[i].empty(); ++j) {
      std::set<std::size_t> both = explained[i];
      both.insert(explained[j].begin(), explained[j].end());
      if (both.size() > std::max(explained[i].size(), explained[j].size())) covers.push_back({both.size(), {i, j}});
    }
  }
  std::stable_sort(covers.begin(), covers.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t n = 0; n < std::min(kMostTried, covers.size()); ++n) pairs.insert(covers[n].second);
  const std::vector<Sum> added = sums(all);
  for (std::size_t n = 0; n < std::min(kMostTried, added.size()); ++n) pairs.insert({added[n].first, added[n].second});
  const std::vector<Suspect> alone = ranked(all, probes);
  for (std::size_t other = 0; other < all.size() && !alone.empty(); ++other) {
    if (other != alone.front().hypothesis) pairs.insert(std::minmax(alone.front().hypothesis, other));
  }
  return pairs;
}

}  // namespace rigor::inline analysis
