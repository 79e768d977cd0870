#include "cases/analysis/tuning/setting_chooser.h"

#include <fmt/format.h>

#include <algorithm>

#include "cases/analysis/sweep/sweep_axis.h"

namespace rigor::inline analysis {
namespace {

constexpr double kShare = 0.25;                 // of the run
constexpr std::size_t kCoarse = 5, kFine = 11;  // 1/30 s, 1/100 s

// A number has no effect if both ends and the middle of its range change nothing.
std::vector<std::string> few_of(const OptionInfo& option) {
  const std::vector<std::string> all = tried_values(option);
  if (!option.choices.empty() || all.size() <= 3) return all;
  return {all.front(), all[all.size() / 2], all.back()};
}

std::vector<std::string> runs_of(const MethodSpace& space, const OptionInfo& option,
                                 const std::vector<std::string>& values) {
  std::vector<std::string> runs;
  for (const std::string& value : values) runs.push_back(with_option(space.base, option.name, value));
  return runs;
}

}  // namespace

// Runs each of these once.
void SettingChooser::screen(const std::vector<std::string>& runs, double limit, double share, Effects& effects) {
  std::vector<Probe> probes;
  for (const std::string& run : runs) {
    if (effects.contains(run)) continue;
    for (const std::size_t step : {kCoarse, kFine}) probes.push_back({run, step});
  }
  const auto answers = prober_.run(probes, {.share = share, .jobs = options_.jobs, .limit = limit});
  for (std::size_t i = 0; i < probes.size(); ++i) {
    Effect& effect = effects[probes[i].run];
    effect.values.insert(effect.values.end(), answers[i].values.begin(), answers[i].values.end());
    effect.seconds = std::max(effect.seconds, answers[i].seconds), effect.is_late |= answers[i].is_late;
  }
}

// Whether the option has an effect, told by a few of its values. If so, the others are run, too.
bool SettingChooser::screen_option(const MethodSpace& space, const OptionInfo& option, double limit, double share,
                                   Effects& effects) {
  const std::vector<std::string> few = runs_of(space, option, few_of(option));
  screen(few, limit, share, effects);
  const bool has_effect = std::any_of(few.begin(), few.end(), [&](const std::string& run) {
    return effects.at(run).values != effects.at(space.base).values;
  });
  if (has_effect) screen(runs_of(space, option, tried_values(option)), limit, share, effects);
  return has_effect;
}

// Leaves out values that change nothing and values that make the run far dearer. An option that changes nothing at
// first may do so later, at a contact for example. Therefore only whole runs show that it is without effect.
SettingChooser::Choices SettingChooser::options_with_effect(const MethodSpace& space) {
  Choices choices;
  const Runnable screened = runnable(space);
  for (const OptionInfo& option : space.options) {
    // The option that makes the method run at all is compared with the method that does not.
    const MethodSpace& from = option.name == screened.needed ? space : screened.space;
    screen({from.base}, options_.limit, kShare, short_);
    const double limit = std::max(kLeastLimit, kFarDearer * short_.at(from.base).seconds);
    bool has_effect = screen_option(from, option, limit, kShare, short_);
    const Effects& effects = has_effect ? short_ : whole_;
    if (!has_effect) {
      screen({from.base}, options_.limit, 1, whole_);
      has_effect = screen_option(from, option, limit / kShare, 1, whole_);
    }
    const std::vector<std::string> values = values_with_effect(from, option, effects);
    if (!has_effect) without_effect_.push_back(fmt::format("{} of {}", option.name, space.base));
    if (!values.empty()) choices.emplace_back(option.name, values);
  }
  return choices;
}

// The space itself, if its method runs without an option; otherwise it with the first value of an option that has a
// result. MuJoCo, for example, has no restitution unless a run names the damping of contacts.
SettingChooser::Runnable SettingChooser::runnable(const MethodSpace& space) {
  const auto has_result = [&](const std::string& run) {
    const std::vector<double>& values = short_.at(run).values;
    return std::any_of(values.begin(), values.end(), [](double value) { return value != ProbeAnswer::kNone; });
  };
  screen({space.base}, options_.limit, kShare, short_);
  if (has_result(space.base)) return {space, ""};
  for (const OptionInfo& option : space.options) {
    const std::vector<std::string> runs = runs_of(space, option, tried_values(option));
    screen(runs, options_.limit, kShare, short_);
    const auto found = std::find_if(runs.begin(), runs.end(), has_result);
    if (found != runs.end()) return {{*found, space.options}, option.name};
  }
  return {space, ""};
}

// Values whose runs differ from the unchanged method's and from each other's.
std::vector<std::string> SettingChooser::values_with_effect(const MethodSpace& space, const OptionInfo& option,
                                                            const Effects& effects) {
  std::vector<std::vector<double>> seen = {effects.at(space.base).values};
  std::vector<std::string> values;
  for (const std::string& value : tried_values(option)) {
    const auto effect = effects.find(with_option(space.base, option.name, value));
    if (effect == effects.end() || effect->second.is_late) continue;
    if (std::find(seen.begin(), seen.end(), effect->second.values) != seen.end()) continue;
    seen.push_back(effect->second.values), values.push_back(value);
  }
  return values;
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

}  // namespace rigor::inline analysis
