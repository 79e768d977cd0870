#include "cases/cli/progress/durations.h"

#include <fmt/format.h>

#include <cmath>

namespace rigor::inline cli {
namespace {

struct Rounded {
  double value;
  const char* unit;
};

constexpr double kMostSeconds = 100, kMostMinutes = 100;  // of a number in that unit

// Whole seconds up to ten and tens of them beyond, whole minutes, whole hours.
Rounded rounded_duration(double seconds, double (*round)(double)) {
  constexpr double kMinute = 60, kHour = 3600, kTen = 10;
  if (seconds < kTen) return {round(seconds), "s"};
  if (seconds < kMostSeconds) return {kTen * round(seconds / kTen), "s"};
  if (seconds < kMostMinutes * kMinute) return {round(seconds / kMinute), "minutes"};
  return {round(seconds / kHour), "hours"};
}

std::string text_of_duration(const Rounded& duration) {
  const std::string unit = duration.value == 1 && duration.unit[1] != '\0'
                               ? std::string(duration.unit).substr(0, std::string(duration.unit).size() - 1)
                               : duration.unit;
  return fmt::format("{:.0f} {}", duration.value, unit);
}

double floored(double value) { return std::floor(value); }
double raised(double value) { return std::ceil(value); }

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < kMostSeconds) return fmt::format("{:.0f} s", seconds);
  return text_of_duration(rounded_duration(seconds, [](double value) { return std::round(value); }));
}

std::string duration_range(double least, double most) {
  const Rounded low = rounded_duration(least, floored), high = rounded_duration(most, raised);
  const std::string end = text_of_duration(high);
  if (text_of_duration(low) == end) return end;
  if (std::string(low.unit) == high.unit) return fmt::format("{:.0f} to {}", low.value, end);
  return fmt::format("{} to {}", text_of_duration(low), end);
}

}  // namespace rigor::inline cli
