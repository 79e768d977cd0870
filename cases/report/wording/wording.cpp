#include "cases/report/wording/wording.h"

#include <fmt/format.h>

#include <cmath>

namespace rigor {

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

std::string rounded(double value) {
  if (!std::isfinite(value)) return "not finite";
  if (value != 0 && (std::abs(value) < 1e-3 || std::abs(value) >= 1e4)) return fmt::format("{:.1e}", value);
  return fmt::format("{:.3g}", value);
}

}  // namespace rigor
