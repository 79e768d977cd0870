#include "core/engine/option_values.h"

#include <fmt/format.h>

#include <cstdlib>

namespace rigor::inline engine {

const OptionDefault& default_of(const OptionInfo& option, Track track) {
  return track == Track::stock && option.as_shipped ? *option.as_shipped : option.by_default;
}

std::optional<std::string> default_value(const OptionInfo& option, Track track) {
  const OptionDefault& value = default_of(option, track);
  if (const auto* number = std::get_if<double>(&value)) return fmt::format("{}", *number);
  if (const auto* word = std::get_if<std::string>(&value)) return *word;
  return std::nullopt;
}

std::string default_text(const OptionInfo& option) {
  const auto text_on = [&](Track track) {
    const auto* rule = std::get_if<DefaultRule>(&default_of(option, track));
    return rule ? rule->text : *default_value(option, track);
  };
  const std::string matched = text_on(Track::matched), stock = text_on(Track::stock);
  return matched == stock ? matched : fmt::format("{}; stock: {}", matched, stock);
}

bool is_named(const Settings& settings, const OptionInfo& option) {
  return settings.options.find(option.name) != settings.options.end();
}

double number_option(const Settings& settings, const OptionInfo& option, double by_rule) {
  if (is_named(settings, option)) return std::strtod(settings.options.at(option.name).c_str(), nullptr);
  const auto* number = std::get_if<double>(&default_of(option, settings.track));
  return number ? *number : by_rule;
}

double number_option(const Settings& settings, const OptionInfo& option) {
  if (is_named(settings, option)) return number_option(settings, option, 0);
  return std::get<double>(default_of(option, settings.track));
}

std::string word_option(const Settings& settings, const OptionInfo& option) {
  return is_named(settings, option) ? settings.options.at(option.name)
                                    : std::get<std::string>(default_of(option, settings.track));
}

std::optional<double> number_to_set(const Settings& settings, const OptionInfo& option) {
  const bool is_rule = std::holds_alternative<DefaultRule>(default_of(option, settings.track));
  if (!is_named(settings, option) && (settings.track == Track::stock || is_rule)) return std::nullopt;
  return number_option(settings, option, 0);
}

std::optional<std::string> word_to_set(const Settings& settings, const OptionInfo& option) {
  const bool is_rule = std::holds_alternative<DefaultRule>(default_of(option, settings.track));
  if (!is_named(settings, option) && (settings.track == Track::stock || is_rule)) return std::nullopt;
  return word_option(settings, option);
}

}  // namespace rigor::inline engine
