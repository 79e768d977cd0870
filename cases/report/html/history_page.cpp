#include "cases/report/html/history_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/analysis/cell_history.h"
#include "cases/report/html/svg.h"
#include "cases/report/wording/wording.h"

namespace rigor::inline report {
namespace {

constexpr double kPlotLeft = 62, kPlotTop = 10, kPlotWidth = 420, kPlotHeight = 90, kPlotBottom = 34,
                 kPlotRight = 12;             // of a drawing, px
constexpr std::size_t kMostCellsDrawn = 400;  // cells

// The range of the finite values other than 0, and a tenth of a decade around them.
struct Decades {
  double least = HUGE_VAL, most = 0;
  explicit Decades(const std::vector<double>& values) {
    for (const double value : values) {
      if (std::isfinite(value) && value != 0)
        least = std::min(least, std::abs(value)), most = std::max(most, std::abs(value));
    }
    if (most == 0) least = most = 1;
    least /= 1.26, most *= 1.26;
  }
  double share(double value) const {
    return std::isfinite(value) ? std::clamp(std::log(std::abs(value) / least) / std::log(most / least), 0.0, 1.0)
                                : 1.0;
  }
};

std::string hint_of(const HistoryEntry& entry, const std::string& value) {
  const std::string date = entry.date.empty() ? "" : " (" + escaped(entry.date.substr(0, 10)) + ")";
  return fmt::format("<title>{}{}: {}</title>", escaped(entry.commit), date, value);
}

std::string axis_label(const HistoryEntry& entry) {
  return entry.commit.substr(0, std::min<std::size_t>(8, entry.commit.find(' ')));
}

// A mark is red where a new level begins; at the top, and red, where the run had no finite value.
std::string curve(const CellSeries& series, const std::vector<HistoryEntry>& history) {
  const Decades decades(series.values);
  const auto x_of = [&](std::size_t i) {
    return kPlotLeft + kPlotWidth * (static_cast<double>(i) + 0.5) / static_cast<double>(history.size());
  };
  std::string path, marks, text;
  for (std::size_t i = 0; i < series.values.size(); ++i) {
    const double value = series.values[i];
    if (std::isnan(value)) continue;
    const bool is_change = std::find(series.changes.begin(), series.changes.end(), i) != series.changes.end();
    const double y = kPlotTop + kPlotHeight * (1 - decades.share(value));
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : " L", x_of(i), y);
    marks += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\">{}</circle>", x_of(i), y,
                         is_change ? 4.5 : 2.5, is_change || !std::isfinite(value) ? "#b3261e" : "#3b76c4",
                         hint_of(history[i], rounded(value)));
    if (is_change) text += svg_line(x_of(i), kPlotTop, x_of(i), kPlotTop + kPlotHeight, "axis");
  }
  text += svg_line(kPlotLeft, kPlotTop + kPlotHeight, kPlotLeft + kPlotWidth, kPlotTop + kPlotHeight, "axis");
  for (const double value : {decades.least * 1.26, decades.most / 1.26})
    text += svg_text(kPlotLeft - 6, kPlotTop + kPlotHeight * (1 - decades.share(value)) + 4, tick(value), "end");
  text += svg_text(x_of(0), kPlotTop + kPlotHeight + 16, axis_label(history.front()));
  if (history.size() > 1)
    text += svg_text(x_of(history.size() - 1), kPlotTop + kPlotHeight + 16, axis_label(history.back()));
  return text + fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"#3b76c4\" stroke-width=\"1.4\"/>", path) + marks;
}

std::string sentence(const std::string& name, const CellSeries& series, const std::vector<HistoryEntry>& history) {
  std::string text = name;
  for (std::size_t which = 0; which < series.changes.size(); ++which) {
    const LevelChange change = level_change(series, which);
    text += fmt::format("{} {} to {} at {}", which == 0 ? ": from" : "; from", rounded(change.before),
                        rounded(change.after), history[change.entry].commit);
  }
  return text;
}

std::string figure_of(const std::string& name, const CellSeries& series, const std::vector<HistoryEntry>& history) {
  const bool has_values =
      std::any_of(series.values.begin(), series.values.end(), [](double v) { return !std::isnan(v); });
  if (!has_values) return "";
  return fmt::format(
      "<figure><svg width=\"{0:g}\" height=\"{1:g}\" viewBox=\"0 0 {0:g} {1:g}\" role=\"img\" "
      "aria-label=\"{4}\">{2}</svg>"
      "<figcaption>{3}</figcaption></figure>\n",
      kPlotLeft + kPlotWidth + kPlotRight, kPlotTop + kPlotHeight + kPlotBottom, curve(series, history),
      escaped(sentence(name, series, history)), escaped(name + " from entry to entry"));
}

}  // namespace

std::string history_section(const CellHistory& cell, const std::vector<HistoryEntry>& history) {
  std::string text = fmt::format("<h3>{}</h3>\n", escaped(cell.name));
  if (!cell.status_change.empty()) text += fmt::format("<p>status: {}</p>\n", escaped(cell.status_change));
  const std::string error = cell.metric.empty() ? "" : figure_of(cell.metric, cell.error, history);
  return text + "<div class=\"row\">\n" + error + figure_of("cost [s/s]", cell.cost, history) + "</div>\n";
}

std::string history_page(const std::vector<HistoryEntry>& history, const std::vector<std::string>& words) {
  std::string text = page_head("Rigor: a history") + "<h1>How errors and costs moved</h1>\n";
  if (history.empty()) return text + "<p>The history is empty: rigor history add DIR begins it.</p>\n</body></html>\n";
  std::vector<CellHistory> cells = cell_histories(history, words);
  std::stable_partition(cells.begin(), cells.end(), [](const CellHistory& cell) { return cell.has_changed(); });
  const auto changed =
      std::count_if(cells.begin(), cells.end(), [](const CellHistory& cell) { return cell.has_changed(); });
  text += fmt::format(
      "<p>{} entries, from {} ({}) to {} ({}). {} of {} cells changed; they come first. Costs are those measured on "
      "{}.</p>\n"
      "<p class=\"faint\">A red mark begins a new level. An error repeats bit for bit, so any change counts. A "
      "cost must change by more than its noise. Scales are logarithmic.</p>\n",
      history.size(), escaped(history.front().commit), history.front().date.substr(0, 10),
      escaped(history.back().commit), history.back().date.substr(0, 10), changed, cells.size(),
      escaped(history.back().machine));
  for (std::size_t i = 0; i < std::min(cells.size(), kMostCellsDrawn); ++i) text += history_section(cells[i], history);
  if (cells.size() > kMostCellsDrawn)
    text += fmt::format("<p>{} more cells are not drawn; name cases or engines to see them.</p>\n",
                        cells.size() - kMostCellsDrawn);
  return text + "</body></html>\n";
}

}  // namespace rigor::inline report
