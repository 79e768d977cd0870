#include "cases/cli/options.h"

#include <fmt/format.h>

#include <charconv>

#include "core/base/error.h"

namespace rigor::inline cli {

void Options::add_flag(const std::string& name, const std::string& meaning, bool& value) {
  rows_.push_back({{name, "", meaning}, Repeats::no, [&value](const std::string&) { value = true; }});
}

void Options::add(const OptionFact& fact, std::string& value) {
  add(fact, [&value](const std::string& text) { value = text; });
}

void Options::add(OptionFact fact, std::vector<std::string>& values) {
  fact.meaning += "; may be repeated";
  add(
      std::move(fact), [&values](const std::string& text) { values.push_back(text); }, Repeats::yes);
}

void Options::add(OptionFact fact, std::function<void(const std::string&)> read, Repeats repeats) {
  rows_.push_back({std::move(fact), repeats, std::move(read)});
}

void Options::end_reading() const {
  for (const auto& act : after_reading_) act();
}

void Options::prepare_run() const {
  for (const auto& act : before_run_) act();
}

int parse_count(const std::string& text, const std::string& option, int most) {
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < 1 || count > most)
    throw InputError(fmt::format("{}: '{}' is not a whole number from 1 to {}", option, text, most));
  return count;
}

std::string either_of(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? " or " : ", ") + names[i];
  return text;
}

}  // namespace rigor::inline cli
