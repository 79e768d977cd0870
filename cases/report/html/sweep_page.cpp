#include "cases/report/html/sweep_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "cases/report/csv/sweep_table.h"
#include "cases/report/html/svg.h"

namespace rigor::inline report {
namespace {

using namespace sweep_drawing;
constexpr double kBottom = 48, kRight = 30;  // px, below and beside a drawing
constexpr std::size_t kMostDrawn = 4000;     // points of one
constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();

struct Kind {
  const char *word, *colour;
};
// The verdicts of cells, from the best to the worst. The colours of light and dark are in svg.cpp.
constexpr Kind kKinds[] = {{"stable", "var(--stable)"},           {"drifting", "var(--drifting)"},
                           {"overlapping", "var(--overlapping)"}, {"gaining", "var(--gaining)"},
                           {"collapsed", "var(--collapsed)"},     {"tunnelled", "var(--tunnelled)"},
                           {"blown up", "var(--blown-up)"},       {"unsupported", "var(--unsupported)"},
                           {"invalid", "var(--invalid)"},         {"broke off", "var(--broke-off)"}};
constexpr unsigned char kBlownUp = 6, kUnsupported = 7, kInvalid = 8, kBrokeOff = 9;

unsigned char kind_of(const SweepRow& row) {
  if (row.status == Status::unsupported) return kUnsupported;
  if (row.status == Status::crashed || row.status == Status::timed_out) return kBrokeOff;
  for (unsigned char kind = 0; kind < kUnsupported; ++kind) {
    if (row.verdict == kKinds[kind].word && row.status != Status::invalid) return kind;
  }
  return kInvalid;
}

std::string key_of(const std::string& style, const std::string& text) {
  return fmt::format("<span class=\"key\"><i style=\"background:{}\"></i>{}</span>", style, escaped(text));
}

const char* colour_of_run(std::size_t run) {
  static constexpr const char* kColours[] = {"var(--run-0)", "var(--run-1)", "var(--run-2)", "var(--run-3)",
                                             "var(--run-4)", "var(--run-5)", "var(--run-6)", "var(--run-7)"};
  return kColours[run % std::size(kColours)];
}

std::string drawing(const std::string& inside, const std::string& caption) {
  return fmt::format(
      "<figure><svg width=\"{0:g}\" height=\"{1:g}\" viewBox=\"0 0 {0:g} {1:g}\" role=\"img\">{2}</svg>"
      "<figcaption>{3}</figcaption></figure>\n",
      kLeft + kWidth + kRight, kTop + kHeight + kBottom, inside, escaped(caption));
}

}  // namespace

double SweepPage::Range::share(double value) const {
  if (!(most > least)) return 0.5;
  return std::log(std::clamp(value, least, most) / least) / std::log(most / least);
}

SweepPage::SweepPage(const Sweep& sweep) : sweep_(sweep) {
  for (const SweepAxis& axis : sweep.axes()) {
    Key key{with_unit(axis.key, unit_of_axis(axis)), axis.values, axis.is_log, axis.from, axis.to};
    if (!axis.is_range && sweep.is_sampled()) key.from = -0.5, key.to = static_cast<double>(axis.values.size()) - 0.5;
    keys_.push_back(std::move(key));
  }
  const bool has_step_axis = std::any_of(sweep.axes().begin(), sweep.axes().end(),
                                         [](const SweepAxis& axis) { return axis.kind == SweepAxis::Kind::step; });
  Key steps{"dt [s]", {}, true, 0, 0};
  for (const Case& definition : sweep.cases()) {
    for (const StepSize& dt : definition.dt) {
      if (std::find(steps.values.begin(), steps.values.end(), dt.text) == steps.values.end())
        steps.values.push_back(dt.text);
    }
  }
  if (!has_step_axis && is_grid() && steps.values.size() > 1) keys_.push_back(std::move(steps));
  error_names_ = {"position_error", "orientation_error", "energy_drift_synchronised"};
  if (sweep.asks_for_metrics()) {
    error_names_ = sweep.metrics();
    error_names_.resize(std::min(error_names_.size(), kErrors));
  }
}

bool SweepPage::has_key_of_steps() const { return keys_.size() > sweep_.axes().size(); }

void SweepPage::add(const SweepRow& row) {
  Point point{row.of_case,
              row.run,
              {},
              kind_of(row),
              {kNothing, kNothing, kNothing},
              {},
              static_cast<float>(stiffest_frequency_of(row) * row.dt.seconds)};
  const auto number_of_value = [](const Key& key, const std::string& value) {
    return static_cast<float>(std::find(key.values.begin(), key.values.end(), value) - key.values.begin());
  };
  for (std::size_t i = 0; i < row.values.size(); ++i) {
    const bool is_drawn = sweep_.is_sampled() && sweep_.axes()[i].is_range;
    point.at.push_back(is_drawn ? static_cast<float>(number_in(row.values[i]))
                                : number_of_value(keys_[i], row.values[i]));
  }
  if (has_key_of_steps()) point.at.push_back(number_of_value(keys_.back(), row.dt.text));
  for (std::size_t i = 0; i < error_names_.size(); ++i) {
    const auto& names = sweep_.metrics();
    const auto found = std::find(names.begin(), names.end(), error_names_[i]);
    if (found != names.end())
      point.errors[i] = static_cast<float>(row.metrics[static_cast<std::size_t>(found - names.begin())]);
    const auto& own = row.held_to_itself;
    point.is_held_to_itself[i] = std::find(own.begin(), own.end(), error_names_[i]) != own.end();
  }
  points_.push_back(std::move(point));
}

double SweepPage::share_of(std::size_t key, const Point& point) const {
  const Key& of = keys_[key];
  if (is_grid()) return (point.at[key] + 0.5) / static_cast<double>(of.values.size());
  if (of.is_log) return std::log(point.at[key] / of.from) / std::log(of.to / of.from);
  return (point.at[key] - of.from) / (of.to - of.from);
}

SweepPage::Points SweepPage::points_of(std::size_t of_case, std::size_t run) const {
  Points points;
  for (const Point& point : points_) {
    if (point.of_case == of_case && point.run == run) points.push_back(&point);
  }
  return points;
}

// The first that says anything.
std::size_t SweepPage::error_shown(std::size_t of_case) const {
  constexpr float kSomething = 1e-12f;
  for (std::size_t i = 0; i < error_names_.size(); ++i) {
    for (const Point& point : points_) {
      if (point.of_case == of_case && std::abs(point.errors[i]) > kSomething) return i;
    }
  }
  return 0;
}

SweepPage::Range SweepPage::range_of(std::size_t of_case, std::size_t error) const {
  Range range{std::numeric_limits<double>::infinity(), 0};
  for (const Point& point : points_) {
    const double value = std::abs(point.errors[error]);
    if (point.of_case != of_case || !(value > 0) || !std::isfinite(value) || point.kind >= kBlownUp) continue;
    range.least = std::min(range.least, value), range.most = std::max(range.most, value);
  }
  return range.most > 0 ? range : Range{1, 1};
}

std::string SweepPage::hint(const Point& point, std::size_t error) const {
  std::string text;
  for (std::size_t i = 0; i < keys_.size(); ++i) {
    const bool is_value = is_grid() || keys_[i].from == -0.5;
    text += fmt::format("{} = {}\n", keys_[i].name,
                        is_value ? keys_[i].values[static_cast<std::size_t>(point.at[i])] : tick(point.at[i]));
  }
  text += kKinds[point.kind].word;
  if (!std::isnan(point.errors[error])) {
    const std::string number = tick(point.errors[error]);
    text += fmt::format(", {} {}", error_names_[error],
                        point.is_held_to_itself[error] ? fmt::format("({})", number) : number);
  }
  if (point.omega_dt > 0) text += fmt::format("\nω dt = {}", tick(point.omega_dt));
  return "<title>" + escaped(text) + "</title>";
}

// A few of a key's values, so that no two labels meet.
std::string SweepPage::ticks(std::size_t key, bool is_x) const {
  std::string text;
  const Key& of = keys_[key];
  const bool is_list = is_grid() || of.from == -0.5;
  const std::size_t count = is_list ? of.values.size() : 5, most = is_x ? 5 : 8;
  const std::size_t every = std::max<std::size_t>(1, (count + most - 1) / most);
  for (std::size_t i = 0; i < count; i += every) {
    const double share = is_list ? (static_cast<double>(i) + 0.5) / static_cast<double>(count)
                                 : static_cast<double>(i) / static_cast<double>(count - 1);
    const double drawn = of.is_log ? of.from * std::pow(of.to / of.from, share) : of.from + share * (of.to - of.from);
    const double number = is_list ? number_in(of.values[i]) : drawn;
    const bool is_short = is_list && (std::isnan(number) || of.values[i].size() <= 6);
    const std::string label = is_short ? of.values[i] : tick(number);
    text += is_x ? svg_text(kLeft + share * kWidth, kTop + kHeight + 15, label)
                 : svg_text(kLeft - 6, kTop + (1 - share) * kHeight + 4, label, "end");
  }
  return text;
}

std::string SweepPage::frame(std::size_t x_key, const std::string& y_label) const {
  const double bottom = kTop + kHeight;
  return svg_line(kLeft, bottom, kLeft + kWidth, bottom, "axis") + svg_line(kLeft, kTop, kLeft, bottom, "axis") +
         ticks(x_key, true) + svg_text(kLeft + kWidth / 2, bottom + 36, keys_[x_key].name) +
         svg_text(14, kTop + kHeight / 2, y_label, "middle", -90);
}

std::string SweepPage::error_ticks(const Range& range) const {
  std::string text;
  for (int i = 0; i <= 4; ++i) {
    const double value = range.least * std::pow(range.most / range.least, i / 4.0), y = kTop + (1 - i / 4.0) * kHeight;
    text += svg_line(kLeft, y, kLeft + kWidth, y, "rule") + svg_text(kLeft - 6, y + 4, tick(value), "end");
  }
  return text;
}

// The keys of a map are the last and the one before: a step, where it is among them, lies along x.
std::string SweepPage::map(const Points& points, std::size_t error, const Range* range) const {
  const bool first_is_step = keys_[0].name == "dt [s]";
  const std::size_t x = first_is_step ? 0 : 1, y = 1 - x;
  const double width = kWidth / static_cast<double>(keys_[x].values.size()),
               height = kHeight / static_cast<double>(keys_[y].values.size());
  std::string text = frame(x, keys_[y].name) + ticks(y, false);
  for (const Point* point : points) {
    const double value = std::abs(point->errors[error]);
    const bool has_shade = range && point->kind < kBlownUp && std::isfinite(value);
    const std::string colour = !range                    ? kKinds[point->kind].colour
                               : has_shade               ? shade(range->share(std::max(value, range->least)))
                               : point->kind == kBlownUp ? kKinds[kBlownUp].colour
                                                         : kKinds[kUnsupported].colour;
    // A little wider than its place, or the paper shines through between two.
    text += fmt::format("<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"{}\">{}</rect>",
                        kLeft + point->at[x] * width, kTop + kHeight - (point->at[y] + 1) * height, width + 0.3,
                        height + 0.3, colour, points.size() <= kMostDrawn ? hint(*point, error) : "");
  }
  return text + limit_in_map(points, x, y);
}

std::string SweepPage::lines(std::size_t of_case, std::size_t error, const Range& range) const {
  std::string text = frame(0, with_unit(error_names_[error], unit_of_metric(error_names_[error]))) + error_ticks(range);
  for (std::size_t run = 0; run < sweep_.runs().size(); ++run) {
    std::string path, marks;
    bool is_begun = false;
    for (const Point* point : points_of(of_case, run)) {
      const double value = std::abs(point->errors[error]), x = kLeft + share_of(0, *point) * kWidth;
      const bool is_there = point->kind < kBlownUp && std::isfinite(value);
      const double y = kTop + (1 - (is_there ? range.share(std::max(value, range.least)) : 1)) * kHeight;
      if (is_there) path += fmt::format("{}{:.1f} {:.1f}", is_begun ? " L" : "M", x, y);
      is_begun = is_there;
      if (is_there || point->kind == kBlownUp)
        marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\">{}</circle>", x, y,
                             is_there ? colour_of_run(run) : kKinds[kBlownUp].colour, hint(*point, error));
    }
    text += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"/>", path, colour_of_run(run)) +
            marks;
  }
  return text + limit_in_lines(of_case);
}

std::string SweepPage::scatter(const Points& points, std::size_t key, std::size_t error, const Range& range) const {
  std::string text =
      frame(key, with_unit(error_names_[error], unit_of_metric(error_names_[error]))) + error_ticks(range);
  const std::size_t every = std::max<std::size_t>(1, (points.size() + kMostDrawn - 1) / kMostDrawn);
  for (std::size_t i = 0; i < points.size(); i += every) {
    const Point& point = *points[i];
    const double value = std::abs(point.errors[error]);
    if (point.kind > kBlownUp) continue;
    const double up = point.kind == kBlownUp || !std::isfinite(value) ? 1 : range.share(std::max(value, range.least));
    text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"2.6\" fill=\"{}\" fill-opacity=\"0.75\">{}</circle>",
                        kLeft + share_of(key, point) * kWidth, kTop + (1 - up) * kHeight, kKinds[point.kind].colour,
                        hint(point, error));
  }
  return text;
}

std::string SweepPage::scatter_of_two(const Points& points) const {
  std::string text = frame(1, keys_[0].name) + ticks(0, false);
  const std::size_t every = std::max<std::size_t>(1, (points.size() + kMostDrawn - 1) / kMostDrawn);
  for (std::size_t i = 0; i < points.size(); i += every) {
    text += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3\" fill=\"{}\">{}</circle>",
                        kLeft + share_of(1, *points[i]) * kWidth, kTop + (1 - share_of(0, *points[i])) * kHeight,
                        kKinds[points[i]->kind].colour, hint(*points[i], 0));
  }
  return text;
}

std::string SweepPage::legend(std::size_t of_case) const {
  std::array<std::size_t, std::size(kKinds)> counts{};
  for (const Point& point : points_) counts[point.kind] += point.of_case == of_case;
  std::string text = "<p>";
  for (std::size_t kind = 0; kind < counts.size(); ++kind) {
    if (counts[kind] > 0) text += key_of(kKinds[kind].colour, fmt::format("{} {}", kKinds[kind].word, counts[kind]));
  }
  return text + "</p>\n" + limit_key(of_case);
}

std::string SweepPage::section(std::size_t of_case) const {
  const Case& definition = sweep_.cases()[of_case];
  const std::size_t error = error_shown(of_case);
  const Range range = range_of(of_case, error);
  const std::string error_name = with_unit(error_names_[error], unit_of_metric(error_names_[error]));
  std::string text =
      fmt::format("<h2>{}</h2>\n<p class=\"faint\">{}</p>\n", escaped(definition.id), escaped(definition.title)) +
      legend(of_case);
  const bool is_map = is_grid() && keys_.size() == 2, is_line = is_grid() && keys_.size() <= 1;
  if (is_map) {
    text += fmt::format(
        "<p>{}: <span class=\"key\">{} <span class=\"bar\" style=\"background:linear-gradient(90deg,{},{},"
        "{},{},{})\"></span> {}</span></p>\n",
        escaped(error_name), tick(range.least), shade(0), shade(0.25), shade(0.5), shade(0.75), shade(1),
        tick(range.most));
  }
  if (is_line) {
    text += "<p>";
    for (std::size_t run = 0; run < sweep_.runs().size(); ++run)
      text += key_of(colour_of_run(run), sweep_.runs()[run].text);
    text += "</p>\n" +
            (keys_.empty() ? "" : drawing(lines(of_case, error, range), error_name + "; red at the top: blown up"));
    return text;
  }
  for (std::size_t run = 0; run < sweep_.runs().size(); ++run) {
    const Points points = points_of(of_case, run);
    text += fmt::format("<h3>{}</h3>\n<div class=\"row\">\n", escaped(sweep_.runs()[run].text));
    if (is_map) {
      text += drawing(map(points, error, nullptr), "verdict");
      text += drawing(map(points, error, &range), error_name + "; red: blown up, grey: no value");
    } else {
      if (keys_.size() == 2) text += drawing(scatter_of_two(points), "verdict");
      for (std::size_t key = 0; key < keys_.size(); ++key)
        text += drawing(scatter(points, key, error, range), error_name + "; red at the top: blown up");
    }
    text += "</div>\n";
  }
  return text;
}

std::string SweepPage::text() const {
  std::string keys;
  for (const SweepAxis& axis : sweep_.axes()) {
    const bool is_drawn = sweep_.is_sampled() && axis.is_range;
    keys += fmt::format(
        "{}{} ({})", keys.empty() ? "" : ", ", with_unit(axis.key, unit_of_axis(axis)),
        is_drawn ? fmt::format("{:g} to {:g}", axis.from, axis.to) : fmt::format("{} values", axis.values.size()));
  }
  if (sweep_.is_sampled()) keys += ", sampled";
  std::string page = page_head("Rigor: a sweep");
  page += fmt::format(
      "<h1>A sweep of {} cells</h1>\n<p>{}</p>\n<p class=\"faint\">Every row with all its metrics is in "
      "sweep.csv and sweep.jsonl. Point at a mark for its numbers.</p>\n",
      sweep_.cells(), escaped(keys));
  for (std::size_t of_case = 0; of_case < sweep_.cases().size(); ++of_case) page += section(of_case);
  return page + "</body></html>\n";
}

}  // namespace rigor::inline report
