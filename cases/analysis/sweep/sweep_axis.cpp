#include "cases/analysis/sweep/sweep_axis.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <charconv>
#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "core/base/error.h"

namespace rigor::inline analysis {
namespace {

constexpr double kNoNumber = std::numeric_limits<double>::quiet_NaN();

constexpr const char* kForm = "a list as 10,20,50, a range as 0.1..0.9:9, or one in logarithms as 1/1000..1/10:log:20";

[[noreturn]] void refuse_axis(const std::string& text, const std::string& what) {
  throw InputError(fmt::format("--vary {}: {}; allowed: KEY=VALUES, where VALUES is {}", text, what, kForm));
}

std::vector<std::string> split(const std::string& text, char mark) {
  std::vector<std::string> parts;
  std::size_t at = 0;
  for (std::size_t end; (end = text.find(mark, at)) != std::string::npos; at = end + 1)
    parts.push_back(text.substr(at, end - at));
  parts.push_back(text.substr(at));
  return parts;
}

double plain_number(const std::string& text) {
  double number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  return error == std::errc() && end == text.data() + text.size() && std::isfinite(number) ? number : kNoNumber;
}

double at_share(const SweepAxis& axis, double share) {
  if (share <= 0) return axis.from;
  if (share >= 1) return axis.to;
  if (!axis.is_log) return axis.from + share * (axis.to - axis.from);
  return axis.from * std::pow(axis.to / axis.from, share);
}

// Twelve digits: 0.3 is 0.3, not 0.30000000000000004.
std::string written(double value) { return fmt::format("{:.12g}", value); }

long read_count(const std::string& text, const std::string& word) {
  const double count = plain_number(word);
  if (!(count >= 2 && count <= kMostValues && count == std::floor(count)))
    refuse_axis(text, fmt::format("found a count of '{}', and a range has from 2 to {} values", word, kMostValues));
  return static_cast<long>(count);
}

void read_range(SweepAxis& axis, const std::string& text, const std::string& values, bool is_sampled) {
  const std::vector<std::string> parts = split(values, ':');
  const std::size_t dots = parts[0].find("..");
  const std::string from = parts[0].substr(0, dots), to = parts[0].substr(dots + 2);
  axis.is_range = true, axis.from = number_in(from), axis.to = number_in(to);
  if (std::isnan(axis.from) || std::isnan(axis.to))
    refuse_axis(text, fmt::format("'{}' is no range of numbers", parts[0]));
  if (axis.from == axis.to) refuse_axis(text, "the range begins where it ends");
  if (axis.from > axis.to) refuse_axis(text, fmt::format("the range is the wrong way round; give {}..{}", to, from));
  axis.is_log = parts.size() > 1 && parts[1] == "log";
  if (axis.is_log && axis.from <= 0) refuse_axis(text, "a range in logarithms begins above 0");
  const std::size_t numbers = 1 + axis.is_log;
  if (parts.size() > 2 && !axis.is_log)
    refuse_axis(text, fmt::format("there is no scale '{}'; there is: log", parts[1]));
  if (parts.size() > numbers + 1) refuse_axis(text, fmt::format("found '{}' behind the count", parts[numbers + 1]));
  if (parts.size() == numbers && !is_sampled) refuse_axis(text, "the range has no count of values");
  const long count = parts.size() > numbers ? read_count(text, parts[numbers]) : 2;
  for (long i = 0; i < count; ++i)
    axis.values.push_back(written(at_share(axis, static_cast<double>(i) / static_cast<double>(count - 1))));
}

SweepAxis::Kind kind_of(const std::string& key) {
  using AxisKind = SweepAxis::Kind;
  if (key == "dt") return AxisKind::step;
  if (key == "duration") return AxisKind::length;
  return key == "scene" || key.starts_with("scene.") || key.starts_with("scene[") ? AxisKind::scene : AxisKind::option;
}

}  // namespace

double number_in(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return plain_number(text);
  const double below = plain_number(text.substr(slash + 1));
  return below > 0 ? plain_number(text.substr(0, slash)) / below : kNoNumber;
}

SweepAxis parse_axis(const std::string& text, bool is_sampled) {
  SweepAxis axis;
  const std::size_t equals = std::min(text.find('='), text.size());
  axis.key = text.substr(0, equals), axis.kind = kind_of(axis.key);
  if (axis.key.empty() || equals >= text.size() - 1) refuse_axis(text, "found no key, or no values");
  const std::string values = text.substr(equals + 1);
  if (values.find("..") != std::string::npos && values.find(',') == std::string::npos) {
    read_range(axis, text, values, is_sampled);
  } else {
    axis.values = split(values, ',');
  }
  std::set<std::string> seen;
  for (std::string& value : axis.values) {
    if (value.empty()) refuse_axis(text, "found an empty value");
    const double number = number_in(value);
    if (axis.kind != SweepAxis::Kind::option && std::isnan(number))
      refuse_axis(text, fmt::format("'{}' is no number", value));
    // A scene has no fractions; a step keeps the one it was given by.
    if (axis.kind == SweepAxis::Kind::scene) value = written(number);
    if (!seen.insert(value).second) refuse_axis(text, fmt::format("the value {} is given twice", value));
  }
  return axis;
}

std::string value_at(const SweepAxis& axis, double share) {
  if (axis.is_range) return written(axis.is_whole ? std::round(at_share(axis, share)) : at_share(axis, share));
  const auto index = static_cast<std::size_t>(share * static_cast<double>(axis.values.size()));
  return axis.values[std::min(index, axis.values.size() - 1)];
}

void make_whole(SweepAxis& axis) {
  axis.is_whole = true;
  std::vector<std::string> whole;
  for (const std::string& value : axis.values) {
    const double number = number_in(value);
    const std::string rounded = axis.is_range ? written(std::round(number)) : value;
    if (std::find(whole.begin(), whole.end(), rounded) == whole.end()) whole.push_back(rounded);
  }
  axis.values = whole;
}

std::string unit_of_axis(const SweepAxis& axis) {
  if (axis.kind == SweepAxis::Kind::step || axis.kind == SweepAxis::Kind::length) return "s";
  if (axis.kind == SweepAxis::Kind::option) return "";
  std::string name = axis.key.substr(axis.key.rfind('.') + 1);
  name.resize(std::min(name.find('['), name.size()));
  const bool of_joint = axis.key.starts_with("scene.joint");
  if (of_joint && (name == "stiffness" || name == "quadratic_stiffness" || name == "damping" || name == "rest" ||
                   name == "lower" || name == "upper"))
    return "";  // about an axis or along it
  static const std::vector<std::pair<std::string, std::string>> units = {{"angular_velocity", "rad/s"},
                                                                         {"damping", "N s/m"},
                                                                         {"force", "N"},
                                                                         {"friction", "1"},
                                                                         {"from", "s"},
                                                                         {"gravity", "m/s²"},
                                                                         {"inertia", "kg m²"},
                                                                         {"length", "m"},
                                                                         {"mass", "kg"},
                                                                         {"offset", "m"},
                                                                         {"orientation_wxyz", "1"},
                                                                         {"point", "m"},
                                                                         {"point_a", "m"},
                                                                         {"point_b", "m"},
                                                                         {"position", "m"},
                                                                         {"quadratic_stiffness", "N/m²"},
                                                                         {"radius", "m"},
                                                                         {"rest_length", "m"},
                                                                         {"restitution", "1"},
                                                                         {"size", "m"},
                                                                         {"stiffness", "N/m"},
                                                                         {"torque", "N m"},
                                                                         {"until", "s"},
                                                                         {"velocity", "m/s"}};
  const auto row = std::find_if(units.begin(), units.end(), [&](const auto& unit) { return unit.first == name; });
  return row == units.end() ? "" : row->second;
}

std::vector<std::vector<double>> sample_points(std::size_t count, std::size_t axes, unsigned long seed) {
  boost::random::sobol sequence(axes);
  std::mt19937_64 engine(seed);
  // Made by hand: what the standard's distributions draw differs from library to library.
  const auto draw = [&] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  std::vector<double> offsets(axes);
  for (double& offset : offsets) offset = draw();
  std::vector<std::vector<double>> points(count, std::vector<double>(axes));
  for (std::vector<double>& point : points) {
    for (std::size_t i = 0; i < axes; ++i) {
      const double share = static_cast<double>(sequence() >> 11) * 0x1p-53 + offsets[i];
      point[i] = share - std::floor(share);
    }
  }
  return points;
}

}  // namespace rigor::inline analysis
