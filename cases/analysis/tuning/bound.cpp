#include "cases/analysis/tuning/bound.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <vector>

#include "cases/metrics/metric.h"
#include "core/base/error.h"
#include "core/base/near_match.h"

namespace rigor::inline analysis {
namespace {

struct UnitRow {
  const char *unit, *metric;
  double size;  // in the metric's unit
};
constexpr UnitRow kUnits[] = {{"m", "position_error", 1},
                              {"cm", "position_error", 1e-2},
                              {"mm", "position_error", 1e-3},
                              {"um", "position_error", 1e-6},
                              {"rad", "orientation_error", 1},
                              {"mrad", "orientation_error", 1e-3},
                              {"deg", "orientation_error", std::numbers::pi / 180},
                              {"%energy", "energy_drift_synchronised", 1e-2}};

[[noreturn]] void refuse_bound(const std::string& text, const std::string& what) {
  throw InputError(
      fmt::format("--within: found '{}'{}; allowed: as 1mm, 1cm, 0.5um (position), 1mrad, 2deg "
                  "(orientation), '2% energy', or METRIC=VALUE",
                  text, what));
}

double read_positive(const std::string& word, const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number) || number <= 0)
    refuse_bound(text, fmt::format(", in which '{}' is no number greater than 0", word));
  return number;
}

Bound bound_on(const std::string& metric, const std::string& value, const std::string& text) {
  std::vector<std::string> known;
  for (const MetricRow& row : metrics()) {
    if (!row.higher_is_better && row.name != "cost") known.push_back(row.name);
  }
  if (std::find(known.begin(), known.end(), metric) == known.end())
    refuse_bound(text, fmt::format(", and there is no metric '{}' to bound{}", metric, did_you_mean(metric, known)));
  return {metric, read_positive(value, text), text};
}

}  // namespace

Bound parse_bound(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos) return bound_on(text.substr(0, equals), text.substr(equals + 1), text);
  std::string plain = text;
  std::erase(plain, ' ');
  const std::size_t unit_at = std::min(plain.find_first_not_of("0123456789.eE+-"), plain.size());
  // The e of a number's power, and no other, belongs to the number.
  const std::string unit = plain.substr(unit_at);
  const auto row = std::find_if(std::begin(kUnits), std::end(kUnits), [&](const UnitRow& r) { return unit == r.unit; });
  if (row == std::end(kUnits))
    refuse_bound(text, unit.empty() ? ", which has no unit" : fmt::format(", whose unit is '{}'", unit));
  return {row->metric, read_positive(plain.substr(0, unit_at), text) * row->size, text};
}

}  // namespace rigor::inline analysis
