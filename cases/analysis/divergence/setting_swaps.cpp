#include "cases/analysis/divergence/setting_swaps.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"

namespace rigor {
namespace {

using Side = RunPair::Side;
using SwapKind = SettingSwap::Kind;

const char* track_word(Track track) { return track == Track::stock ? "stock" : "matched"; }

// The run's name as reports write it.
RunName named(const std::string& engine, const Settings& settings, const EngineTable& engines) {
  std::string text = engine;
  if (engines.info_of(engine).methods.size() > 1) text += ":" + settings.method;
  for (const auto& [option, value] : settings.options) text += fmt::format(",{}={}", option, value);
  if (settings.track == Track::stock) text += "@stock";
  return parse_run_name(text, engines.infos());
}

const OptionInfo* option_of(const MethodInfo& method, const std::string& name) {
  const auto row =
      std::find_if(method.options.begin(), method.options.end(), [&](const auto& o) { return o.name == name; });
  return row == method.options.end() ? nullptr : &*row;
}

// One of the two runs, and what is in force in it.
struct SideFacts {
  const DivergingRun& run;
  const SettingsInForce& in_force;
  const MethodInfo& method;

  bool names(const std::string& option) const { return run.name.settings.options.contains(option); }
  // Empty if a rule decides.
  std::string value(const OptionInfo& option) const {
    const auto own = run.name.settings.options.find(option.name);
    if (own != run.name.settings.options.end()) return own->second;
    return default_value(option, run.name.settings.track).value_or("");
  }
  std::string reported(const std::string& key) const {
    const auto row = std::find_if(in_force.begin(), in_force.end(), [&](const auto& r) { return r.first == key; });
    return row == in_force.end() ? "" : row->second;
  }
};

bool takes(const OptionInfo& option, const std::string& value, const SideFacts& own, const EngineTable& engines) {
  Settings settings = own.run.name.settings;
  settings.options[option.name] = value;
  try {
    named(own.run.name.engine, settings, engines);
  } catch (const InputError&) {
    return false;
  }
  return true;
}

// Options of one method in both runs: those whose values differ.
void add_same_method(const SideFacts& a, const SideFacts& b, std::vector<SettingSwap>& swaps) {
  for (const OptionInfo& option : b.method.options) {
    const std::string in_a = a.value(option), in_b = b.value(option);
    if (in_a == in_b && a.names(option.name) == b.names(option.name)) continue;
    if (in_a == in_b && !in_a.empty()) continue;
    const bool clears = !a.names(option.name) && a.run.name.settings.track == b.run.name.settings.track;
    if (in_a.empty() && !clears) continue;  // a rule of another track, which no option can state
    swaps.push_back({SwapKind::option, Side::b, option.name, in_b, in_a, clears});
  }
}

// Options of one of two different methods. The value is that of the other run where it has a setting of this name;
// otherwise each other word that the option takes. A number without counterpart stays: some value of it closes any gap
// by chance.
void add_other_method(const SideFacts& own, const SideFacts& other, Side side, const EngineTable& engines,
                      std::vector<SettingSwap>& swaps) {
  for (const OptionInfo& option : own.method.options) {
    const std::string now = own.value(option);
    const OptionInfo* there = option_of(other.method, option.name);
    std::string target = there ? other.value(*there) : other.reported(option.name);
    if (!target.empty() && !takes(option, target, own, engines)) target.clear();
    if (!target.empty()) {
      if (target != now) swaps.push_back({SwapKind::option, side, option.name, now, target, false});
      continue;
    }
    for (const std::string& choice : option.choices) {
      if (choice != now) swaps.push_back({SwapKind::option, side, option.name, now, choice, false});
    }
  }
}

void add_methods(const SideFacts& own, Side side, const EngineTable& engines, std::vector<SettingSwap>& swaps) {
  for (const MethodInfo& method : engines.info_of(own.run.name.engine).methods) {
    if (method.name != own.method.name && method.twin_of.empty())
      swaps.push_back({SwapKind::method, side, "", own.method.name, method.name, false});
  }
}

Settings with_method(Settings settings, const std::string& name, const EngineInfo& engine) {
  settings.method = name;
  const MethodInfo& method = method_of(engine, settings);
  std::erase_if(settings.options, [&](const auto& own) { return option_of(method, own.first) == nullptr; });
  return settings;
}

// The steps of both runs, until the parting, as samples that are `seconds` apart.
struct SwapTrial {
  std::size_t first = 0;  // of its tasks: A, B
  std::size_t last = 0;   // sample of the parting
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
  std::vector<double> shares(const std::vector<std::pair<DivergingRun, DivergingRun>>& runs, long finer,
                             std::vector<std::string>& why) const {
    std::vector<MotionTask> tasks;
    std::vector<SwapTrial> trials;
    for (const auto& [a, b] : runs) {
      trials.push_back({tasks.size(), 0, ""});
      add_tasks(a, b, finer, tasks, trials.back());
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

  double unswapped(long finer) const {
    std::vector<std::string> why;
    return shares({{pair_.run(Side::a), pair_.run(Side::b)}}, finer, why).front();
  }

  std::vector<TriedSwap> tried(const std::vector<std::vector<SettingSwap>>& candidates, double whole) const {
    std::vector<TriedSwap> all;
    std::vector<std::pair<DivergingRun, DivergingRun>> runs;
    for (const auto& swaps : candidates) {
      TriedSwap one{swaps, pair_.run(Side::a), pair_.run(Side::b), 0, 0, false, ""};
      try {
        for (const SettingSwap& swap : swaps) apply_swap(swap, one.a, one.b, pair_.engines());
      } catch (const InputError&) {
        continue;
      }
      runs.emplace_back(one.a, one.b), all.push_back(one);
    }
    std::vector<std::string> why;
    const std::vector<double> rest = shares(runs, 1, why);
    for (std::size_t n = 0; n < all.size(); ++n) {
      all[n].why = why[n];
      if (all[n].why.empty()) all[n].closes = 1 - rest[n] / whole;
    }
    std::erase_if(all, [](const TriedSwap& one) { return !one.why.empty(); });
    std::stable_sort(all.begin(), all.end(), [](const auto& x, const auto& y) { return x.closes > y.closes; });
    return all;
  }

  // Whether the swap closes the gap with halved steps, too. A step's own error that two settings cancel does not.
  void check(TriedSwap& one) const {
    std::vector<std::string> why;
    const std::vector<double> rest = shares({{pair_.run(Side::a), pair_.run(Side::b)}, {one.a, one.b}}, 2, why);
    if (rest[0] <= 0 || rest[1] < 0) return;
    one.closes_at_half_step = 1 - rest[1] / rest[0], one.is_checked = true;
  }

 private:
  void add_tasks(const DivergingRun& a, const DivergingRun& b, long finer, std::vector<MotionTask>& tasks,
                 SwapTrial& trial) const {
    try {
      for (const DivergingRun* run : {&a, &b}) {
        trial.why =
            why_unsupported(pair_.engines().info_of(run->name.engine), run->name.settings, *scene_, run->dt.seconds);
        if (!trial.why.empty()) return;
      }
      const CommonSteps steps = common_steps(a.dt, b.dt, duration_);
      const long count = static_cast<long>(parting_.time / steps.seconds + 0.5);
      trial.last = static_cast<std::size_t>(count);
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

std::string name_of(const SettingSwap& swap) {
  const std::string what = swap.kind == SwapKind::option   ? swap.option
                           : swap.kind == SwapKind::method ? "method"
                           : swap.kind == SwapKind::track  ? "track"
                                                           : "dt";
  const auto value = [](const std::string& text) { return text.empty() ? "its default" : text; };
  return fmt::format("{}: {} -> {}", what, value(swap.from), value(swap.to));
}

std::vector<SettingSwap> swaps_between(const DivergingRun& a, const DivergingRun& b, const SettingsInForce& in_a,
                                       const SettingsInForce& in_b, const EngineTable& engines) {
  std::vector<SettingSwap> swaps;
  const EngineInfo &engine_a = engines.info_of(a.name.engine), &engine_b = engines.info_of(b.name.engine);
  const SideFacts of_a{a, in_a, method_of(engine_a, a.name.settings)},
      of_b{b, in_b, method_of(engine_b, b.name.settings)};
  const bool is_one_engine = engine_a.name == engine_b.name;
  if (is_one_engine && of_a.method.name == of_b.method.name) {
    add_same_method(of_a, of_b, swaps);
  } else {
    add_other_method(of_b, of_a, Side::b, engines, swaps), add_other_method(of_a, of_b, Side::a, engines, swaps);
    if (is_one_engine) {
      swaps.push_back({SwapKind::method, Side::b, "", of_b.method.name, of_a.method.name, false});
    } else {
      add_methods(of_b, Side::b, engines, swaps), add_methods(of_a, Side::a, engines, swaps);
    }
  }
  if (a.name.settings.track != b.name.settings.track)
    swaps.push_back(
        {SwapKind::track, Side::b, "", track_word(b.name.settings.track), track_word(a.name.settings.track), false});
  if (!(a.dt == b.dt)) swaps.push_back({SwapKind::step, Side::b, "", b.dt.text, a.dt.text, false});
  return swaps;
}

void apply_swap(const SettingSwap& swap, DivergingRun& a, DivergingRun& b, const EngineTable& engines) {
  DivergingRun& run = swap.side == Side::a ? a : b;
  if (swap.kind == SwapKind::step) {
    run.dt = swap.side == Side::a ? b.dt : a.dt;
    return;
  }
  Settings settings = run.name.settings;
  if (swap.kind == SwapKind::method) settings = with_method(settings, swap.to, engines.info_of(run.name.engine));
  if (swap.kind == SwapKind::track) settings.track = swap.to == "stock" ? Track::stock : Track::matched;
  if (swap.kind == SwapKind::option && swap.clears) settings.options.erase(swap.option);
  if (swap.kind == SwapKind::option && !swap.clears) settings.options[swap.option] = swap.to;
  run.name = named(run.name.engine, settings, engines);
}

SwapSearch search_swaps(const RunPair& pair, const Scene& scene, double duration, const SettingsInForce& in_a,
                        const SettingsInForce& in_b, const PartingBounds& bounds, const Parting& parting,
                        const DivergenceOptions& options) {
  constexpr double kNamed = 0.5, kEnough = 0.9, kBetter = 0.1;  // shares of the gap
  SwapSearch search;
  const SwapSearcher searcher(pair, scene, duration, bounds, parting, options);
  const std::vector<SettingSwap> swaps =
      swaps_between(pair.run(Side::a), pair.run(Side::b), in_a, in_b, pair.engines());
  search.has_differing_setting = !swaps.empty();
  const double whole = searcher.unswapped(1);
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
    searcher.check(candidate);
    if (candidate.is_checked && candidate.closes_at_half_step >= kNamed) {
      search.best = candidate;
      break;
    }
  }
  return search;
}

}  // namespace rigor
