#include "cases/case/case.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "core/base/error.h"

namespace rigor::inline cases {
namespace {

std::optional<double> parse_number(std::string_view text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
  return number;
}

// A number, or a fraction of two.
std::optional<double> parse_seconds(std::string_view text) {
  const auto slash = text.find('/');
  const auto numerator = parse_number(text.substr(0, slash));
  if (slash == std::string_view::npos) return numerator;
  const auto denominator = parse_number(text.substr(slash + 1));
  if (!numerator || !denominator || *denominator <= 0) return std::nullopt;
  return *numerator / *denominator;
}

// The part of an unchecked text that is safe to show.
std::string excerpt(const std::string& text) {
  std::string out;
  for (const char c : text.substr(0, 40)) out += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? '?' : c;
  return text.size() > 40 ? out + "..." : out;
}

}  // namespace

bool operator==(const StepSize& a, const StepSize& b) {
  constexpr double kRounding = 1e-9;
  return std::abs(a.seconds - b.seconds) <= kRounding * std::max(a.seconds, b.seconds);
}

std::string kind_of(const Gate& gate) { return gate.regression() ? "regression" : "bound"; }

StepSize parse_step_size(const std::string& text, const std::string& what) {
  constexpr std::size_t kLongest = 40;  // it goes into tables and file names; 17 digits over 17 digits fit
  const auto seconds = text.size() <= kLongest ? parse_seconds(text) : std::nullopt;
  if (!seconds || !std::isfinite(*seconds) || *seconds <= 0) {
    throw InputError(
        fmt::format("{}: found '{}'; allowed: a number of seconds greater than 0, as 0.01, or a fraction, as 1/30",
                    what, excerpt(text)));
  }
  return {*seconds, text};
}

void check_step_size(const StepSize& dt, double duration, const std::string& what) {
  if (dt.seconds > duration) {
    throw InputError(
        fmt::format("{}: found a step of {} s, longer than the run; allowed: at most {} s", what, dt.text, duration));
  }
  constexpr double kMostSteps = 1e12;  // more than a day's work for one body at 100 ns a step
  if (duration / dt.seconds > kMostSteps) {
    throw InputError(
        fmt::format("{}: found a step of {} s, of which a run of {} s has {:.3g}; allowed: at most {:g} steps", what,
                    dt.text, duration, duration / dt.seconds, kMostSteps));
  }
}

}  // namespace rigor::inline cases
