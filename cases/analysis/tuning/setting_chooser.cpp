#include "cases/analysis/tuning/setting_chooser.h"

#include <fmt/format.h>

#include <algorithm>

#include "cases/analysis/sweep/sweep_axis.h"

namespace rigor {
namespace {

constexpr double kShare = 0.25;                 // of the run
constexpr std::size_t kCoarse = 5, kFine = 11;  // 1/30 s, 1/100 s

// A number has no effect if both ends and the middle of its range change nothing.
std::vector<std::string> few_of(const OptionInfo& option) {
  const std::vector<std::string> all = tried_values(option);
  if (!option.choices.empty() || all.size() <= 3) return all;
  return {all.front(), all[all.size() / 2], all.back()};
}

void add_runs(const MethodSpace& space, const OptionInfo& option, const std::vector<std::string>& values,
              std::vector<std::string>& runs) {
  for (const std::string& value : values) runs.push_back(with_option(space.base, option.name, value));
}

}  // namespace

// Runs each of these once.
void SettingChooser::screen(const std::vector<std::string>& runs, double limit) {
  std::vector<Probe> probes;
  for (const std::string& run : runs) {
    if (effects_.contains(run)) continue;
    for (const std::size_t step : {kCoarse, kFine}) probes.push_back({run, step});
  }
  const auto answers = prober_.run(probes, {.share = kShare, .jobs = options_.jobs, .limit = limit});
  for (std::size_t i = 0; i < probes.size(); ++i) {
    Effect& effect = effects_[probes[i].run];
    effect.values.insert(effect.values.end(), answers[i].values.begin(), answers[i].values.end());
    effect.seconds = std::max(effect.seconds, answers[i].seconds), effect.is_late |= answers[i].is_late;
  }
}

bool SettingChooser::has_effect(const MethodSpace& space, const OptionInfo& option) const {
  const auto few = few_of(option);
  return std::any_of(few.begin(), few.end(), [&](const std::string& value) {
    return effects_.at(with_option(space.base, option.name, value)).values != effects_.at(space.base).values;
  });
}

// Leaves out values that change nothing and values that make the run far dearer.
SettingChooser::Choices SettingChooser::options_with_effect(const MethodSpace& space) {
  screen({space.base}, options_.limit);
  const double limit = std::max(kLeastLimit, kFarDearer * effects_.at(space.base).seconds);
  std::vector<std::string> runs;
  for (const OptionInfo& option : space.options) add_runs(space, option, few_of(option), runs);
  screen(runs, limit);
  runs.clear();
  for (const OptionInfo& option : space.options) {
    if (has_effect(space, option)) add_runs(space, option, tried_values(option), runs);
  }
  screen(runs, limit);
  Choices choices;
  for (const OptionInfo& option : space.options) {
    if (!has_effect(space, option)) {
      without_effect_.push_back(fmt::format("{} of {}", option.name, space.base));
      continue;
    }
    std::vector<std::vector<double>> seen = {effects_.at(space.base).values};
    std::vector<std::string> values;
    for (const std::string& value : tried_values(option)) {
      const Effect& effect = effects_.at(with_option(space.base, option.name, value));
      if (effect.is_late || std::find(seen.begin(), seen.end(), effect.values) != seen.end()) continue;
      seen.push_back(effect.values), values.push_back(value);
    }
    if (!values.empty()) choices.emplace_back(option.name, values);
  }
  return choices;
}

std::vector<std::string> SettingChooser::settings_of(const MethodSpace& space, std::size_t most) {
  std::vector<std::string> runs = {space.base};
  if (most <= 1) return runs;  // nothing is left to choose
  const Choices choices = options_with_effect(space);
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

}  // namespace rigor
