#include "core/engine/engine.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "core/engine/run_name.h"
#include "core/scene/joint_traits.h"

namespace rigor::inline engine {
namespace {

// The first need that the choice does not meet, among the needs that some choice of the option meets.
const Need* unmet(const OptionInfo& option, const std::string& choice, const std::vector<Need>& needs) {
  const Features& features = option.features_of_choice.at(choice);
  const auto is_of_option = [&](const Need& need) {
    return std::any_of(option.features_of_choice.begin(), option.features_of_choice.end(),
                       [&](const auto& row) { return row.second.contains(need.feature); });
  };
  const auto need = std::find_if(needs.begin(), needs.end(),
                                 [&](const Need& n) { return is_of_option(n) && !features.contains(n.feature); });
  return need == needs.end() ? nullptr : &*need;
}

// Returns "" if the choice in force meets the scene's needs. Without a choice in force, any choice may meet them.
std::string why_choice_fails(const std::string& engine, const OptionInfo& option, const Settings& settings,
                             const std::vector<Need>& needs) {
  std::vector<std::string> would_do;
  for (const std::string& choice : option.choices) {
    if (!unmet(option, choice, needs)) would_do.push_back(option.name + "=" + choice);
  }
  const auto named = settings.options.find(option.name);
  if (named == settings.options.end() && !would_do.empty()) return "";
  const std::string choice = named == settings.options.end() ? option.choices.back() : named->second;
  const Need* need = unmet(option, choice, needs);
  if (!need) return "";
  return fmt::format("{} with {}={} has no {}, which {} asks for; {}", engine, option.name, choice,
                     word_of(need->feature), need->because,
                     would_do.empty() ? "no other choice has all that the scene needs"
                                      : fmt::format("{} would do", fmt::join(would_do, " or ")));
}

bool gives_if_named(const OptionInfo& option, Feature feature) {
  const auto row = option.features_of_choice.find("");
  return row != option.features_of_choice.end() && row->second.contains(feature);
}

// Returns "" if the method has the feature, or a named option gives it.
std::string why_method_fails(const EngineInfo& engine, const Settings& settings, const MethodInfo& method,
                             const Need& need) {
  if (!method.lacks.contains(need.feature)) return "";
  std::string would_do;
  for (const OptionInfo& option : method.options) {
    if (!gives_if_named(option, need.feature)) continue;
    if (settings.options.contains(option.name)) return "";
    would_do = fmt::format("; a run that names {} has it", option.name);
  }
  return fmt::format("{}:{} has no {}, which {} asks for; its method: {}{}", engine.name, method.name,
                     word_of(need.feature), need.because, method.summary, would_do);
}

}  // namespace

std::string why_unsupported(const EngineInfo& engine, const Scene& scene, double dt) {
  for (const Need& need : needs_of(scene)) {
    if (!engine.features.contains(need.feature)) {
      return fmt::format("{} has no {}, which {} asks for", engine.name, word_of(need.feature), need.because);
    }
  }
  for (const Body& body : scene.bodies) {
    const double angle = body.angular_velocity.norm() * dt;
    if (angle > engine.max_rotation_per_step) {
      return fmt::format("{} turns a body by at most {:.3g} rad in one step; '{}' turns by {:.3g} rad", engine.name,
                         engine.max_rotation_per_step, body.name, angle);
    }
  }
  return "";
}

std::string why_unsupported(const EngineInfo& engine, const Settings& settings, const Scene& scene, double dt) {
  const std::string why = why_unsupported(engine, scene, dt);
  if (!why.empty()) return why;
  const std::vector<Need> needs = needs_of(scene);
  const MethodInfo& method = method_of(engine, settings);
  std::vector<Need> asked = joint_traits_of(scene);
  asked.insert(asked.begin(), needs.begin(), needs.end());
  for (const Need& need : asked) {
    const std::string method_fails = why_method_fails(engine, settings, method, need);
    if (!method_fails.empty()) return method_fails;
  }
  for (const OptionInfo& option : method.options) {
    if (option.features_of_choice.empty() || option.choices.empty()) continue;
    const std::string choice_fails = why_choice_fails(engine.name, option, settings, needs);
    if (!choice_fails.empty()) return choice_fails;
  }
  return "";
}

}  // namespace rigor::inline engine
