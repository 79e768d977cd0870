#include "cases/analysis/divergence/swap_search.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace rigor::inline analysis {
namespace {

using Side = RunPair::Side;

// The steps of both runs, until the parting or longer.
struct SwapTrial {
  std::size_t first = 0;  // of its tasks: A, B
  std::size_t last = 0;   // sample up to which they are compared
  double seconds = 0;     // between samples
  std::string why;
};

class SwapSearcher {
 public:
  SwapSearcher(const RunPair& pair, const Scene& scene, double duration, const PartingBounds& bounds,
               const Parting& parting, const DivergenceOptions& options)
      : pair_(pair),
        scene_(std::make_shared<Scene>(scene)),
        duration_(duration),
        bounds_(bounds),
        parting_(parting),
        options_(options) {}

  // The largest share of the bound until the parting; negative where a run failed.
  std::vector<double> shares(const std::vector<std::pair<DivergingRun, DivergingRun>>& runs,
                             std::vector<std::string>& why) const {
    std::vector<MotionTask> tasks;
    std::vector<SwapTrial> trials;
    for (const auto& [a, b] : runs) {
      trials.push_back({tasks.size(), 0, 0, ""});
      add_tasks(a, b, 1, parting_.time, tasks, trials.back());
    }
    const std::vector<StateSeries> motions = pair_.motions(tasks);
    std::vector<double> found;
    for (const SwapTrial& trial : trials) {
      why.push_back(trial.why);
      if (trial.why.empty()) {
        found.push_back(share_of_trial(motions[trial.first], motions[trial.first + 1], trial, why.back()));
      } else {
        found.push_back(-1);
      }
    }
    return found;
  }

  double unswapped() const {
    std::vector<std::string> why;
    return shares({{pair_.run(Side::a), pair_.run(Side::b)}}, why).front();
  }

  std::vector<TriedSwap> tried(const std::vector<std::vector<SettingSwap>>& candidates, double whole) const {
    std::vector<TriedSwap> all;
    std::vector<std::pair<DivergingRun, DivergingRun>> runs;
    for (const auto& swaps : candidates) {
      TriedSwap one;
      one.swaps = swaps, one.a = pair_.run(Side::a), one.b = pair_.run(Side::b);
      try {
        for (const SettingSwap& swap : swaps) apply_swap(swap, one.a, one.b, pair_.engines());
      } catch (const InputError&) {
        continue;
      }
      runs.emplace_back(one.a, one.b), all.push_back(one);
    }
    std::vector<std::string> why;
    const std::vector<double> rest = shares(runs, why);
    for (std::size_t n = 0; n < all.size(); ++n) {
      all[n].why = why[n];
      if (all[n].why.empty()) all[n].closes = 1 - rest[n] / whole;
    }
    std::erase_if(all, [](const TriedSwap& one) { return !one.why.empty(); });
    std::stable_sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.closes > y.closes; });
    return all;
  }

  // Whether the swap closes the gap with halved steps, too. A step's own error that two settings cancel does not.
  // `whole`: the gap at the full steps.
  void check(TriedSwap& one, double whole) const {
    constexpr double kVanished = 0.1;  // of the gap: what is left then is not the difference that the swap closed
    HalfSteps at = half_steps(one, parting_.time);
    if (at.gap >= 0 && at.gap < kVanished * whole) {
      at = half_steps(one, std::min(duration_, kLonger * parting_.time));
      one.has_gap_at_half_step = at.gap >= 1;
    }
    if (at.gap < 0 || at.rest < 0 || !one.has_gap_at_half_step) return;
    one.closes_at_half_step = 1 - at.rest / at.gap, one.is_checked = true;
  }

 private:
  static constexpr double kLonger = 4;  // times the time until the parting

  // The gap of the two runs at halved steps and the rest that the swap leaves: the largest shares until the gap leaves
  // the bound, or for `until` [s]. Negative where a run failed.
  struct HalfSteps {
    double gap = -1, rest = -1;
  };
  HalfSteps half_steps(const TriedSwap& one, double until) const {
    std::vector<MotionTask> tasks;
    SwapTrial whole, swapped;
    add_tasks(pair_.run(Side::a), pair_.run(Side::b), 2, until, tasks, whole);
    swapped.first = tasks.size();
    add_tasks(one.a, one.b, 2, until, tasks, swapped);
    if (!whole.why.empty() || !swapped.why.empty()) return {};
    const std::vector<StateSeries> motions = pair_.motions(tasks);
    if (until > parting_.time) {
      const MotionView a(motions[0], scene_->bodies.size()), b(motions[1], scene_->bodies.size());
      const std::size_t samples = std::min({a.samples(), b.samples(), whole.last + 1});
      whole.last = samples - std::min<std::size_t>(samples, 1);
      for (std::size_t n = 0; n < whole.last; ++n)
        if (share_at(a, b, *scene_, bounds_, n).share > 1) whole.last = n;
      const double parts = static_cast<double>(whole.last) * whole.seconds;
      swapped.last = static_cast<std::size_t>(parts / swapped.seconds + 0.5);
    }
    std::string why;
    return {share_of_trial(motions[0], motions[1], whole, why),
            share_of_trial(motions[swapped.first], motions[swapped.first + 1], swapped, why)};
  }

  void add_tasks(const DivergingRun& a, const DivergingRun& b, long finer, double until, std::vector<MotionTask>& tasks,
                 SwapTrial& trial) const {
    try {
      for (const DivergingRun* run : {&a, &b}) {
        trial.why =
            why_unsupported(pair_.engines().info_of(run->name.engine), run->name.settings, *scene_, run->dt.seconds);
        if (!trial.why.empty()) return;
      }
      const CommonSteps steps = common_steps(a.dt, b.dt, duration_);
      const long count = static_cast<long>(until / steps.seconds + 0.5);
      trial.last = static_cast<std::size_t>(count), trial.seconds = steps.seconds;
      const RunPair changed(pair_.engines(), a, b, steps, options_);
      tasks.push_back(changed.task(Side::a, scene_, count, finer));
      tasks.push_back(changed.task(Side::b, scene_, count, finer));
    } catch (const InputError& error) {
      trial.why = error.what();
    }
  }

  double share_of_trial(const StateSeries& x, const StateSeries& y, const SwapTrial& trial, std::string& why) const {
    why = x.why.empty() ? y.why : x.why;
    if (!why.empty()) return -1;
    const MotionView in_x(x, scene_->bodies.size()), in_y(y, scene_->bodies.size());
    if (std::min(in_x.samples(), in_y.samples()) <= trial.last) {
      why = "a run blows up";
      return -1;
    }
    return largest_share(in_x, in_y, *scene_, bounds_, trial.last).share;
  }

  const RunPair& pair_;
  std::shared_ptr<const Scene> scene_;
  double duration_;
  const PartingBounds& bounds_;
  const Parting& parting_;
  const DivergenceOptions& options_;
};

// Two settings may act only together, so the best ones are paired also where neither helps alone.
std::vector<std::vector<SettingSwap>> pairs_of(const std::vector<TriedSwap>& singles) {
  constexpr std::size_t kBest = 4;
  std::vector<std::vector<SettingSwap>> pairs;
  for (std::size_t i = 0; i < std::min(kBest, singles.size()); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const SettingSwap &x = singles[k].swaps.front(), &y = singles[i].swaps.front();
      const bool is_one = x.kind == y.kind && x.side == y.side && x.option == y.option;
      if (!is_one) pairs.push_back({x, y});
    }
  }
  return pairs;
}

}  // namespace

SwapSearch search_swaps(const RunPair& pair, const Scene& scene, double duration, const SettingsInForce& in_a,
                        const SettingsInForce& in_b, const PartingBounds& bounds, const Parting& parting,
                        const DivergenceOptions& options) {
  constexpr double kNamed = 0.5, kEnough = 0.9, kBetter = 0.1;  // shares of the gap
  SwapSearch search;
  const SwapSearcher searcher(pair, scene, duration, bounds, parting, options);
  const std::vector<SettingSwap> swaps =
      swaps_between(pair.run(Side::a), pair.run(Side::b), in_a, in_b, pair.engines());
  search.has_differing_setting = !swaps.empty();
  const double whole = searcher.unswapped();
  if (swaps.empty() || whole <= 0) return search;
  std::vector<std::vector<SettingSwap>> singles;
  for (const SettingSwap& swap : swaps) singles.push_back({swap});
  search.tried = searcher.tried(singles, whole);
  if (search.tried.empty()) return search;
  std::vector<std::size_t> candidates = {0};
  if (search.tried.front().closes < kEnough) {
    const std::vector<TriedSwap> pairs = searcher.tried(pairs_of(search.tried), whole);
    if (!pairs.empty() && pairs.front().closes > search.tried.front().closes + kBetter)
      candidates.insert(candidates.begin(), search.tried.size());  // where the first pair will stand
    search.tried.insert(search.tried.end(), pairs.begin(), pairs.end());
  }
  for (const std::size_t number : candidates) {
    TriedSwap& candidate = search.tried[number];
    if (candidate.closes < kNamed) continue;
    searcher.check(candidate, whole);
    const bool holds = candidate.is_checked && candidate.closes_at_half_step >= kNamed;
    if (!holds && candidate.has_gap_at_half_step) continue;
    search.best = candidate;
    break;
  }
  return search;
}

}  // namespace rigor::inline analysis
