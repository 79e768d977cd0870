#include "cases/analysis/tuning/tuning_space.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace rigor::inline analysis {

std::vector<std::string> tried_values(const OptionInfo& option) {
  if (!option.choices.empty()) return option.choices;
  std::vector<double> numbers;
  if (option.min > 0 && option.max / option.min >= 100) {
    constexpr int kSteps = 6;
    for (int i = 0; i <= kSteps; ++i)
      numbers.push_back(option.min * std::pow(option.max / option.min, static_cast<double>(i) / kSteps));
  } else if (option.min == 0) {
    for (const double share : {0.0, 1e-6, 1e-4, 0.01, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0})
      numbers.push_back(share * option.max);
  } else {
    constexpr int kSteps = 6;
    for (int i = 0; i <= kSteps; ++i) numbers.push_back(option.min + (option.max - option.min) * i / kSteps);
  }
  std::vector<std::string> values;
  for (const double number : numbers) {
    const double rounded = std::clamp(std::stod(fmt::format("{:.3g}", number)), option.min, option.max);
    const std::string value = fmt::format("{}", option.whole ? std::round(rounded) : rounded);
    if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
  }
  return values;
}

std::string with_option(const std::string& run, const std::string& option, const std::string& value) {
  const std::size_t track = std::min(run.find('@'), run.size()), there = run.find("," + option + "=");
  std::string head = run.substr(0, track);
  if (there != std::string::npos) {
    const std::size_t end = std::min(head.find(',', there + 1), head.size());
    head.erase(there, end - there);
  }
  return fmt::format("{},{}={}{}", head, option, value, run.substr(track));
}

std::vector<MethodSpace> method_spaces(const std::string& text, const std::vector<EngineInfo>& engines) {
  const RunName named = parse_run_name(text, engines);
  const auto engine =
      std::find_if(engines.begin(), engines.end(), [&](const auto& e) { return e.name == named.engine; });
  const std::string head = text.substr(0, text.find_first_of(",@"));
  const bool names_method = head.find(':') != std::string::npos, names_options = !named.settings.options.empty();
  const std::string track = named.settings.track == Track::stock ? "@stock" : "";
  std::vector<MethodSpace> spaces;
  for (const MethodInfo& method : engine->methods) {
    if ((names_method || names_options) ? method.name != named.settings.method : !method.twin_of.empty()) continue;
    MethodSpace space{engine->methods.size() > 1 ? fmt::format("{}:{}", engine->name, method.name) : engine->name, {}};
    for (const auto& [option, value] : named.settings.options) space.base = with_option(space.base, option, value);
    space.base += track;
    for (const OptionInfo& option : method.options) {
      if (!named.settings.options.contains(option.name)) space.options.push_back(option);
    }
    spaces.push_back(std::move(space));
  }
  return spaces;
}

}  // namespace rigor::inline analysis
