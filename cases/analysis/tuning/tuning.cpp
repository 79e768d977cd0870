#include "cases/analysis/tuning/tuning.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "cases/analysis/sweep/sweep_axis.h"
#include "cases/analysis/tuning/tuning_probe.h"
#include "cases/analysis/tuning/tuning_space.h"

namespace rigor {
namespace {

// A run of the space and the coarsest step at which it has kept the bounds so far.
struct Setting {
  std::string run;
  std::size_t step = 0;
};

class Tuner {
 public:
  Tuner(const std::string& text, const std::vector<Case>& cases, const std::vector<Bound>& bounds,
        const EngineTable& engines, const TuneOptions& options)
      : spaces_(method_spaces(text, engines.infos())), options_(options), prober_(cases, bounds, engines, options) {
    found_.engine = text;
  }

  Tuning run() {
    std::vector<Setting> settings = choose_settings();
    found_.settings = settings.size();
    for (const double share : {0.125, 0.25, 0.5}) settings = halved(std::move(settings), share);
    confirm(settings);
    measure_again();
    found_.runs = prober_.runs();
    found_.remarks = {prober_.remarks().begin(), prober_.remarks().end()};
    return std::move(found_);
  }

 private:
  static constexpr std::size_t kStepsAtOnce = 4, kFewest = 8, kSlack = 7;  // 7 steps of the table: a factor of about 4

  std::vector<Setting> choose_settings() {
    std::vector<Setting> settings;
    const std::size_t share = std::max<std::size_t>(1, options_.settings / std::max<std::size_t>(1, spaces_.size()));
    for (const MethodSpace& space : spaces_) {
      const auto options = options_with_effect(space);
      for (const std::string& run : combined(space, options, share)) settings.push_back({run});
    }
    return settings;
  }

  using Choices = std::vector<std::pair<std::string, std::vector<std::string>>>;  // option, values

  // A value that changes nothing, at two steps of a short run, is as good as the default.
  Choices options_with_effect(const MethodSpace& space) {
    std::vector<std::string> runs = {space.base};
    for (const OptionInfo& option : space.options) {
      for (const std::string& value : tried_values(option)) runs.push_back(with_option(space.base, option.name, value));
    }
    std::vector<Probe> probes;
    for (const std::string& run : runs) {
      for (const std::size_t step : {kScreenedAt, kScreenedAt + 6}) probes.push_back({run, step});
    }
    const auto answers = prober_.run(probes, 0.25, false, options_.jobs);
    const auto effect_of = [&](std::size_t run) {
      std::vector<double> values = answers[2 * run].values;
      values.insert(values.end(), answers[2 * run + 1].values.begin(), answers[2 * run + 1].values.end());
      return values;
    };
    Choices choices;
    std::size_t run = 1;
    for (const OptionInfo& option : space.options) {
      std::vector<std::vector<double>> seen = {effect_of(0)};
      std::vector<std::string> values;
      for (const std::string& value : tried_values(option)) {
        const auto effect = effect_of(run++);
        if (std::find(seen.begin(), seen.end(), effect) != seen.end()) continue;
        seen.push_back(effect), values.push_back(value);
      }
      if (values.empty())
        found_.without_effect.push_back(fmt::format("{} of {}", option.name, space.base));
      else
        choices.emplace_back(option.name, values);
    }
    return choices;
  }

  // All combinations, or as many as there may be: each option by itself first, the rest drawn.
  std::vector<std::string> combined(const MethodSpace& space, const Choices& choices, std::size_t most) const {
    std::vector<std::string> runs = {space.base};
    double all = 1;
    for (const auto& [option, values] : choices) all *= static_cast<double>(values.size() + 1);
    const auto add = [&](const std::string& run) {
      if (std::find(runs.begin(), runs.end(), run) == runs.end() && runs.size() < most) runs.push_back(run);
    };
    if (all <= static_cast<double>(most)) {
      for (const auto& [option, values] : choices) {
        const std::vector<std::string> so_far = runs;
        for (const std::string& run : so_far) {
          for (const std::string& value : values) add(with_option(run, option, value));
        }
      }
      return runs;
    }
    for (const auto& [option, values] : choices) {
      for (const std::string& value : values) add(with_option(space.base, option, value));
    }
    for (const auto& point : sample_points(4 * most, choices.size(), options_.seed)) {
      std::string run = space.base;
      for (std::size_t i = 0; i < choices.size(); ++i) {
        const auto& values = choices[i].second;
        const auto index = static_cast<std::size_t>(point[i] * static_cast<double>(values.size() + 1));
        if (index > 0) run = with_option(run, choices[i].first, values[index - 1]);
      }
      add(run);
    }
    return runs;
  }

  // The settings with their coarsest steps that keep the bounds for this share of the run, the better half of them.
  std::vector<Setting> halved(std::vector<Setting> settings, double share) {
    std::vector<Setting> kept;
    std::size_t best = tuned_steps().size();
    for (Setting& setting : settings) setting.step -= std::min<std::size_t>(setting.step, 2);
    while (!settings.empty()) {
      std::vector<Probe> probes;
      for (const Setting& setting : settings) {
        for (std::size_t i = setting.step; i < std::min(setting.step + kStepsAtOnce, tuned_steps().size()); ++i)
          probes.push_back({setting.run, i});
      }
      const auto answers = prober_.run(probes, share, false, options_.jobs);
      std::vector<Setting> left;
      std::size_t at = 0;
      for (Setting& setting : settings) {
        const std::size_t end = std::min(setting.step + kStepsAtOnce, tuned_steps().size());
        std::size_t first = end;
        for (std::size_t i = setting.step; i < end; ++i, ++at) {
          if (answers[at].error <= 1 && first == end) first = i;
        }
        setting.step = first;
        if (first < end) best = std::min(best, first), kept.push_back(setting);
        if (first == end && end < tuned_steps().size()) left.push_back(setting);
      }
      std::erase_if(left, [&](const Setting& setting) { return setting.step > best + kSlack; });
      settings = std::move(left);
    }
    std::stable_sort(kept.begin(), kept.end(), [](const auto& a, const auto& b) { return a.step < b.step; });
    kept.resize(std::min(kept.size(), std::max(kFewest, kept.size() / 2)));
    return kept;
  }

  void confirm(const std::vector<Setting>& settings) {
    std::vector<Setting> left = settings;
    for (Setting& setting : left) setting.step -= std::min<std::size_t>(setting.step, 2);
    if (left.empty()) left = every_method();
    while (!left.empty()) {
      std::vector<Probe> probes;
      for (const Setting& setting : left) {
        for (std::size_t i = setting.step; i < std::min(setting.step + kStepsAtOnce, tuned_steps().size()); ++i)
          probes.push_back({setting.run, i});
      }
      const auto answers = prober_.run(probes, 1, true, options_.jobs);
      std::vector<Setting> next;
      std::size_t at = 0;
      for (Setting& setting : left) {
        const std::size_t end = std::min(setting.step + kStepsAtOnce, tuned_steps().size());
        bool keeps = false;
        for (std::size_t i = setting.step; i < end; ++i, ++at) keeps |= keep_point(probes[at], answers[at]);
        setting.step = end;
        if (!keeps && end < tuned_steps().size()) next.push_back(setting);
      }
      left = std::move(next);
    }
  }

  // Where nothing keeps the bounds even for a short run: to say in full what came nearest.
  std::vector<Setting> every_method() const {
    std::vector<Setting> settings;
    for (const MethodSpace& space : spaces_) settings.push_back({space.base, tuned_steps().size() - kStepsAtOnce});
    return settings;
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

  // What is cheapest, one at a time so that nothing disturbs it.
  void measure_again() {
    constexpr std::size_t kMost = 6, kRepeats = 5;
    std::vector<TunedPoint*> good;
    for (TunedPoint& point : points_) {
      if (point.keeps()) good.push_back(&point);
    }
    std::stable_sort(good.begin(), good.end(), [](const auto* a, const auto* b) { return a->cost < b->cost; });
    good.resize(std::min(good.size(), kMost));
    std::vector<std::vector<double>> costs(good.size());
    for (std::size_t repeat = 0; repeat < kRepeats && !good.empty(); ++repeat) {
      std::vector<Probe> probes;
      for (const TunedPoint* point : good) probes.push_back({point->run.text, step_of(*point)});
      const auto answers = prober_.run(probes, 1, true, 1);
      for (std::size_t i = 0; i < good.size(); ++i) costs[i].push_back(answers[i].cost);
    }
    for (std::size_t i = 0; i < good.size(); ++i) {
      std::sort(costs[i].begin(), costs[i].end());
      good[i]->least = costs[i].front(), good[i]->most = costs[i].back(), good[i]->cost = costs[i][kRepeats / 2];
    }
    choose_winner(good);
    find_front();
  }

  static std::size_t step_of(const TunedPoint& point) {
    const auto& steps = tuned_steps();
    return static_cast<std::size_t>(std::find(steps.begin(), steps.end(), point.dt) - steps.begin());
  }

  // Of those that repeats cannot tell from the cheapest, the plainest name; then the longest step.
  void choose_winner(std::vector<TunedPoint*> good) {
    if (good.empty()) return say_nearest();
    const auto cheapest =
        *std::min_element(good.begin(), good.end(), [](const auto* a, const auto* b) { return a->cost < b->cost; });
    std::erase_if(good, [&](const TunedPoint* point) { return point->least > cheapest->most; });
    std::stable_sort(good.begin(), good.end(), [](const auto* a, const auto* b) {
      const auto options = [](const TunedPoint* p) { return std::count(p->run.text.begin(), p->run.text.end(), ','); };
      return std::make_tuple(options(a), -a->dt.seconds, a->run.text) <
             std::make_tuple(options(b), -b->dt.seconds, b->run.text);
    });
    found_.winner = *good.front();
    for (std::size_t i = 1; i < good.size(); ++i) found_.ties.push_back(*good[i]);
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

  static constexpr std::size_t kScreenedAt = 5;  // 1/30 s; and 1/100 s
  std::vector<MethodSpace> spaces_;
  const TuneOptions& options_;
  Prober prober_;
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

Tuning tune(const std::string& text, const std::vector<Case>& cases, const std::vector<Bound>& bounds,
            const EngineTable& engines, const TuneOptions& options) {
  return Tuner(text, cases, bounds, engines, options).run();
}

}  // namespace rigor
