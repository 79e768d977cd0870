#include "cases/analysis/tuning/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>

#include "cases/analysis/tuning/setting_chooser.h"
#include "cases/analysis/tuning/setting_refiner.h"

namespace rigor::inline analysis {
namespace {

// A run of the space and the coarsest step that has kept the bounds so far.
struct Setting {
  std::string run;
  std::size_t step = 0;
  const MethodSpace* space = nullptr;
};

class Tuner {
 public:
  Tuner(const std::string& text, const std::vector<Case>& cases, const std::vector<Bound>& bounds,
        const EngineTable& engines, const TuneOptions& options)
      : spaces_(method_spaces(text, engines.infos())),
        engines_(engines),
        options_(options),
        prober_(cases, bounds, engines, options) {
    found_.engine = text;
  }

  Tuning run() {
    const std::vector<Setting> settings = choose_settings();
    found_.settings = settings.size();
    std::vector<Setting> left = settings;
    for (const double share : {0.125, 0.25, 0.5}) left = halved(std::move(left), share);
    confirm(left.empty() ? every_method() : left);
    if (options_.refines && !keeps_anywhere()) confirm(refined(settings));
    measure_again();
    found_.runs = prober_.runs();
    found_.remarks = {prober_.remarks().begin(), prober_.remarks().end()};
    return std::move(found_);
  }

 private:
  static constexpr std::size_t kStepsAtOnce = 4, kFewest = 8, kSlack = 7;  // 7 steps of the table: a factor of about 4

  std::vector<Setting> choose_settings() {
    const std::size_t share = std::max<std::size_t>(1, options_.settings / std::max<std::size_t>(1, spaces_.size()));
    SettingChooser chooser(prober_, options_);
    std::vector<Setting> settings;
    for (const MethodSpace& space : spaces_) {
      for (const std::string& run : chooser.settings_of(space, share)) settings.push_back({run, 0, &space});
    }
    found_.without_effect = chooser.without_effect();
    return settings;
  }

  // The end of the steps that are tried next.
  static std::size_t end_of(const Setting& setting) {
    return std::min(setting.step + kStepsAtOnce, tuned_steps().size());
  }
  static std::vector<Probe> probes_of(const std::vector<Setting>& settings) {
    std::vector<Probe> probes;
    for (const Setting& setting : settings) {
      for (std::size_t i = setting.step; i < end_of(setting); ++i) probes.push_back({setting.run, i});
    }
    return probes;
  }

  // `quickest`: s, of the fastest run that kept the bounds.
  static double limit_beside(double quickest) { return std::max(kLeastLimit, kFarDearer * quickest); }

  // Finds each setting's coarsest step that keeps the bounds for this share of the run, and returns the better half. A
  // setting that is far dearer than one that kept them is dropped, because a finer step is dearer still.
  std::vector<Setting> halved(std::vector<Setting> settings, double share) {
    std::vector<Setting> kept;
    std::size_t best = tuned_steps().size();
    double quickest = ProbeAnswer::kNone;
    for (Setting& setting : settings) setting.step -= std::min<std::size_t>(setting.step, 2);
    while (!settings.empty()) {
      const double limit = limit_beside(std::isfinite(quickest) ? quickest : share * quickest_);
      const auto answers = prober_.run(probes_of(settings), {.share = share, .jobs = options_.jobs, .limit = limit});
      std::vector<Setting> left;
      std::size_t at = 0;
      for (Setting& setting : settings) {
        const std::size_t end = end_of(setting);
        std::size_t first = end;
        bool is_late = false;
        for (std::size_t i = setting.step; i < end; ++i, ++at) {
          is_late |= answers[at].is_late && limit < options_.limit;
          if (answers[at].error > 1 || first != end) continue;
          first = i, quickest = std::min(quickest, answers[at].seconds);
        }
        setting.step = first;
        if (first < end) best = std::min(best, first), kept.push_back(setting);
        if (first == end && end < tuned_steps().size() && !is_late) left.push_back(setting);
      }
      std::erase_if(left, [&](const Setting& setting) { return setting.step > best + kSlack; });
      settings = std::move(left);
    }
    quickest_ = quickest / share;
    std::stable_sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.step < b.step; });
    kept.resize(std::min(kept.size(), std::max(kFewest, kept.size() / 2)));
    return kept;
  }

  void confirm(const std::vector<Setting>& settings) {
    std::vector<Setting> left = settings;
    for (Setting& setting : left) setting.step -= std::min<std::size_t>(setting.step, 2);
    std::size_t best = tuned_steps().size();
    while (!left.empty()) {
      const auto probes = probes_of(left);
      const auto answers =
          prober_.run(probes, {.is_timed = true, .jobs = options_.jobs, .limit = limit_beside(quickest_)});
      std::vector<Setting> next;
      std::size_t at = 0;
      for (Setting& setting : left) {
        const std::size_t end = end_of(setting);
        bool keeps = false;
        for (std::size_t i = setting.step; i < end; ++i, ++at) {
          if (!keep_point(probes[at], answers[at])) continue;
          keeps = true, best = std::min(best, i);
        }
        setting.step = end;
        if (!keeps && end < tuned_steps().size()) next.push_back(setting);
      }
      std::erase_if(next, [&](const Setting& setting) { return setting.step > best + kSlack; });
      left = std::move(next);
    }
  }

  // Used if nothing keeps the bounds even for a short run. Full runs then show the nearest one.
  std::vector<Setting> every_method() const {
    std::vector<Setting> settings;
    for (const MethodSpace& space : spaces_) settings.push_back({space.base, tuned_steps().size() - kStepsAtOnce});
    return settings;
  }

  bool keeps_anywhere() const {
    return std::any_of(points_.begin(), points_.end(), [](const TunedPoint& point) { return point.keeps(); });
  }

  // If no tried value keeps the bounds: settings that keep them with numbers between the tried ones, at the coarsest of
  // a few steps. The search starts where whole runs come nearest.
  std::vector<Setting> refined(const std::vector<Setting>& settings) {
    constexpr std::size_t kSteps[] = {14, 20, 26, 30};  // 1/240, 1/1000, 1/4000, 1/10000 s
    std::vector<Setting> kept;
    for (const std::size_t step : kSteps) {
      for (const auto& [setting, start] : nearest_runs(settings, step)) {
        const Refined best = refine(start, setting->space->options, prober_, engines_, options_.jobs);
        const bool is_new =
            std::none_of(kept.begin(), kept.end(), [&](const Setting& other) { return other.run == best.probe.run; });
        // A run that keeps the bounds is confirmed, with steps around this one.
        if (best.answer.error > 1)
          keep_point(best.probe, best.answer);
        else if (is_new)
          kept.push_back({best.probe.run, best.probe.step, setting->space});
      }
      if (!kept.empty()) break;
    }
    found_.is_refined = !kept.empty();
    return kept;
  }

  using NearRun = std::pair<const Setting*, Refined>;
  std::vector<NearRun> nearest_runs(const std::vector<Setting>& settings, std::size_t step) {
    constexpr std::size_t kStarts = 2;
    std::vector<Probe> probes;
    for (const Setting& setting : settings) probes.push_back({setting.run, step});
    const auto answers = prober_.run(probes, {.is_timed = true, .jobs = options_.jobs});
    std::vector<NearRun> runs;
    for (std::size_t i = 0; i < probes.size(); ++i) {
      if (std::isfinite(answers[i].error)) runs.emplace_back(&settings[i], Refined{probes[i], answers[i]});
    }
    std::stable_sort(runs.begin(), runs.end(),
                     [](const NearRun& a, const NearRun& b) { return a.second.answer.error < b.second.answer.error; });
    runs.resize(std::min(runs.size(), kStarts));
    return runs;
  }

  bool keep_point(const Probe& probe, const ProbeAnswer& answer) {
    TunedPoint point{RunName{"", {}, probe.run},
                     tuned_steps()[probe.step],
                     answer.error,
                     answer.cost,
                     answer.cost,
                     answer.cost,
                     answer.why};
    points_.push_back(point);
    return point.keeps();
  }

  // Measures the cheapest points again, one at a time so that they do not disturb each other. They take turns, so a
  // disturbance of the machine affects all of them.
  void measure_again() {
    constexpr std::size_t kMost = 6, kRepeats = 5;
    constexpr double kNoise = 2;  // times the least cost: two cells at once can hardly disturb each other by more
    std::vector<TunedPoint*> good;
    for (TunedPoint& point : points_) {
      if (point.keeps()) good.push_back(&point);
    }
    std::stable_sort(good.begin(), good.end(), [](const auto* a, const auto* b) { return a->cost < b->cost; });
    std::erase_if(good, [least = good.empty() ? 0 : good.front()->cost](const TunedPoint* point) {
      return point->cost > kNoise * least;
    });
    good.resize(std::min(good.size(), kMost));
    std::vector<Probe> probes;
    for (std::size_t repeat = 0; repeat < kRepeats; ++repeat) {
      for (const TunedPoint* point : good) probes.push_back({point->run.text, step_of(*point)});
    }
    const auto answers = prober_.run(probes, {.is_timed = true});
    for (std::size_t i = 0; i < good.size(); ++i) {
      std::vector<double> costs;
      for (std::size_t at = i; at < answers.size(); at += good.size()) costs.push_back(answers[at].cost);
      std::sort(costs.begin(), costs.end());
      good[i]->least = costs.front(), good[i]->most = costs.back(), good[i]->cost = costs[kRepeats / 2];
    }
    choose_winner(good);
    find_front();
  }

  static std::size_t step_of(const TunedPoint& point) {
    const auto& steps = tuned_steps();
    return static_cast<std::size_t>(std::find(steps.begin(), steps.end(), point.dt) - steps.begin());
  }

  void choose_winner(const std::vector<TunedPoint*>& good) {
    if (good.empty()) return say_nearest();
    std::vector<TunedPoint> points;
    for (const TunedPoint* point : good) points.push_back(*point);
    found_.ties = equally_cheap(std::move(points));
    found_.winner = found_.ties.front();
    found_.ties.erase(found_.ties.begin());
  }

  void say_nearest() {
    const TunedPoint* nearest = nullptr;
    for (const TunedPoint& point : points_) {
      if (point.why.empty() && (!nearest || point.error < nearest->error)) nearest = &point;
    }
    if (nearest) {
      found_.nearest = fmt::format("{} at {} s comes nearest, at {:.3g} times the bound", nearest->run.text,
                                   nearest->dt.text, nearest->error);
    } else if (!points_.empty()) {
      found_.nearest = points_.front().why;
    }
  }

  void find_front() {
    std::vector<TunedPoint> by_cost;
    for (const TunedPoint& point : points_) {
      if (point.why.empty()) by_cost.push_back(point);
    }
    std::stable_sort(by_cost.begin(), by_cost.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
    double least = ProbeAnswer::kNone;
    for (const TunedPoint& point : by_cost) {
      if (point.error < least) least = point.error, found_.front.push_back(point);
    }
  }

  std::vector<MethodSpace> spaces_;
  const EngineTable& engines_;
  const TuneOptions& options_;
  Prober prober_;
  double quickest_ = ProbeAnswer::kNone;  // s: an estimate for a whole run that keeps the bounds
  std::vector<TunedPoint> points_;
  Tuning found_;
};

}  // namespace

const std::vector<StepSize>& tuned_steps() {
  static const std::vector<StepSize> steps = [] {
    std::vector<StepSize> made;
    for (const int n : {10,  12,  15,  20,  24,   30,   40,   50,   60,   80,   100,  120,  150,  200,  240,  300,
                        400, 500, 600, 800, 1000, 1200, 1500, 2000, 2400, 3000, 4000, 5000, 6000, 8000, 10000})
      made.push_back({1.0 / n, fmt::format("1/{}", n)});
    return made;
  }();
  return steps;
}

std::vector<TunedPoint> equally_cheap(std::vector<TunedPoint> points) {
  if (points.empty()) return points;
  const TunedPoint cheapest =
      *std::min_element(points.begin(), points.end(), [](const auto& a, const auto& b) { return a.cost < b.cost; });
  std::erase_if(points, [&](const TunedPoint& point) { return point.least > cheapest.most; });
  std::stable_sort(points.begin(), points.end(), [](const TunedPoint& a, const TunedPoint& b) {
    const auto options = [](const TunedPoint& p) { return std::count(p.run.text.begin(), p.run.text.end(), ','); };
    return std::make_tuple(options(a), -a.dt.seconds, a.run.text) <
           std::make_tuple(options(b), -b.dt.seconds, b.run.text);
  });
  return points;
}

Tuning tune(const std::string& text, const std::vector<Case>& cases, const std::vector<Bound>& bounds,
            const EngineTable& engines, const TuneOptions& options) {
  return Tuner(text, cases, bounds, engines, options).run();
}

}  // namespace rigor::inline analysis
