#include "cases/analysis/divergence/setting_swaps.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/error.h"

namespace rigor::inline analysis {
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

}  // namespace rigor::inline analysis
