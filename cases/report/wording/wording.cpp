#include "cases/report/wording/wording.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

namespace rigor::inline report {

std::string listed_names(const std::vector<std::string>& names, std::size_t most) {
  std::string text;
  for (std::size_t i = 0; i < std::min(most, names.size()); ++i) text += (i ? ", " : "") + names[i];
  return names.size() > most ? text + fmt::format(" and {} more", names.size() - most) : text;
}

std::string shortened(std::string text, std::size_t width) {
  if (text.size() <= width) return text;
  text.resize(width - 2);
  while (!text.empty() && (text.back() & 0xc0) == 0x80) text.pop_back();
  if (!text.empty() && (text.back() & 0x80)) text.pop_back();
  return text + "..";
}

namespace {

std::string with_digits(double value, int digits) {
  if (!std::isfinite(value)) return std::isnan(value) ? "not a number" : value > 0 ? "infinite" : "-infinite";
  if (value == 0) return "0";
  std::string text = fmt::format("{:.{}e}", value, digits - 1);  // 2.0e-05
  const std::size_t e = text.find('e');
  const int exponent = std::stoi(text.substr(e + 1));
  if (exponent >= -3 && exponent < 5) return fmt::format("{:.{}g}", std::stod(text), std::max(digits, exponent + 1));
  std::string mantissa = text.substr(0, e);
  while (mantissa.find('.') != std::string::npos && (mantissa.back() == '0' || mantissa.back() == '.'))
    mantissa.pop_back();
  return fmt::format("{}e{}", mantissa, exponent);
}

}  // namespace

std::string two_digits(double value) { return with_digits(value, 2); }

std::string three_digits(double value) { return with_digits(value, 3); }

std::string quantity_text(double value, const std::string& unit) {
  if (unit.empty()) return two_digits(value);
  const double size = std::abs(value);
  const bool has_prefix = unit == "m" || unit == "s" || unit == "rad";
  if (!has_prefix || size == 0 || !std::isfinite(value) || size >= 0.995 || size < 1e-12)
    return two_digits(value) + " " + unit;
  for (const auto& [factor, prefix] : {std::pair{1e-3, "m"}, {1e-6, "µ"}, {1e-9, "n"}}) {
    if (size >= 0.995 * factor) return fmt::format("{} {}{}", two_digits(value / factor), prefix, unit);
  }
  return fmt::format("{} p{}", two_digits(value / 1e-12), unit);
}

std::string percent_text(double share) { return two_digits(100 * share) + " %"; }

std::string rounded(double value) {
  if (!std::isfinite(value)) return "not finite";
  if (value != 0 && (std::abs(value) < 1e-3 || std::abs(value) >= 1e4)) return fmt::format("{:.1e}", value);
  return fmt::format("{:.3g}", value);
}

}  // namespace rigor::inline report
