#include "core/engine/run_name.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/base/error.h"
#include "core/base/names_of.h"
#include "core/base/near_match.h"

namespace rigor::inline engine {
namespace {

constexpr const char* kForm = "ENGINE[:METHOD][,key=value...][@TRACK]";

// The row with that name, or an error that says what there is instead.
template <typename Rows>
const auto& find_row(const Rows& rows, const std::string& name, const std::string& what, const std::string& run) {
  const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& r) { return r.name == name; });
  if (row != rows.end()) return *row;
  const auto known = names_of(rows);
  throw InputError(fmt::format("'{}': there is no {} '{}'{}; there is: {}", run, what, name, did_you_mean(name, known),
                               known.empty() ? "none" : listed(known)));
}

std::string and_default(const OptionInfo& option) {
  const std::string text = default_text(option);
  return text.empty() ? "" : fmt::format("; default: {}", text);
}

// The value as it is always written: "5e1" and "50" are one.
std::string checked_value(const OptionInfo& option, const std::string& value, const std::string& run) {
  if (!option.choices.empty()) {
    if (std::find(option.choices.begin(), option.choices.end(), value) != option.choices.end()) return value;
    throw InputError(fmt::format("'{}': {} cannot be '{}'{}; it is one of: {}{}", run, option.name, value,
                                 did_you_mean(value, option.choices), listed(option.choices), and_default(option)));
  }
  double number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  const bool read_whole = error == std::errc() && end == value.data() + value.size();
  const bool good =
      read_whole && number >= option.min && number <= option.max && (!option.whole || number == std::floor(number));
  if (!good) {
    throw InputError(fmt::format("'{}': {} cannot be '{}'; it is a {} from {} to {}{}", run, option.name, value,
                                 option.whole ? "whole number" : "number", option.min, option.max,
                                 and_default(option)));
  }
  return fmt::format("{}", number);
}

Track parse_track(const std::string& word, const std::string& run) {
  if (word == "matched") return Track::matched;
  if (word == "stock") return Track::stock;
  const std::vector<std::string> known = {"matched", "stock"};
  throw InputError(
      fmt::format("'{}': there is no track '{}'{}; there is: {}", run, word, did_you_mean(word, known), listed(known)));
}

// Splits off what follows the first `mark`; "" if the mark is not there.
std::string cut_tail(std::string& text, char mark) {
  const auto at = text.find(mark);
  if (at == std::string::npos) return "";
  std::string tail = text.substr(at + 1);
  text.resize(at);
  return tail;
}

void parse_options(std::string rest, const MethodInfo& method, RunName& run, const std::string& text) {
  while (!rest.empty()) {
    std::string pair = rest;
    rest = cut_tail(pair, ',');
    std::string key = pair;
    const std::string value = cut_tail(key, '=');
    if (key == pair) throw InputError(fmt::format("'{}': '{}' has no value; a run is named {}", text, pair, kForm));
    const OptionInfo& option =
        find_row(method.options, key, fmt::format("option of {}:{} called", run.engine, method.name), text);
    if (!run.settings.options.emplace(key, checked_value(option, value, text)).second) {
      throw InputError(fmt::format("'{}': '{}' is given twice", text, key));
    }
  }
}

}  // namespace

const MethodInfo& method_of(const EngineInfo& engine, const Settings& settings) {
  return find_row(engine.methods, settings.method, fmt::format("method of {} called", engine.name), engine.name);
}

RunName parse_run_name(const std::string& text, const std::vector<EngineInfo>& engines) {
  RunName run;
  std::string head = text;
  const bool has_track = text.find('@') != std::string::npos;
  const std::string track = cut_tail(head, '@');
  if (has_track) run.settings.track = parse_track(track, text);
  const bool has_options = head.find(',') != std::string::npos;
  std::string options = cut_tail(head, ',');
  if (has_options && options.empty()) throw InputError(fmt::format("'{}': nothing follows the comma", text));
  const bool has_method = head.find(':') != std::string::npos;
  const std::string method = cut_tail(head, ':');

  const EngineInfo& engine = find_row(engines, head, "engine", text);
  run.engine = engine.name;
  run.settings.method = has_method ? method : engine.methods.front().name;
  const MethodInfo& method_info =
      find_row(engine.methods, run.settings.method, fmt::format("method of {} called", engine.name), text);
  parse_options(std::move(options), method_info, run, text);
  run.text = text;
  return run;
}

}  // namespace rigor::inline engine
