// engines/ENGINE.html: what it is good at, its runs by family, known deviations, settings in force, history.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/report/html/history_page.h"
#include "cases/report/html/svg.h"
#include "cases/report/site/addresses.h"
#include "cases/report/site/site_pages.h"
#include "cases/report/wording/wording.h"
#include "cases/results/main_error.h"

namespace rigor::inline report {
namespace {

constexpr const char* kRootOfEngines = "../";
constexpr std::size_t kMostPictures = 24, kMostSteps = 200, kMostValues = 6;

std::string table_with(const std::string& label, const std::vector<std::string>& heads, const std::string& rows) {
  std::string text = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\">\n<table class=\"plain\">\n<thead><tr>",
      escaped(label));
  for (const std::string& head : heads) text += "<th scope=\"col\">" + escaped(head) + "</th>";
  return text + "</tr></thead>\n<tbody>\n" + rows + "</tbody>\n</table>\n</div>\n";
}

std::string joined(const std::vector<std::string>& names) {
  return names.empty() ? "none" : escaped(fmt::format("{}", fmt::join(names, ", ")));
}

// Of the families in which something is compared.
std::string strengths(const SiteData& data, std::size_t run) {
  std::vector<std::string> good, bad, failing;
  for (const std::string& family : data.families) {
    const Score score = score_of(data.results, run, family, data.headline);
    const std::string name = family.empty() ? "cases" : family;
    if (score.compared > 0 && score.within == score.compared) good.push_back(name);
    if (score.compared > 0 && std::isfinite(score.median) && score.median > 10 * kSiteTolerance) bad.push_back(name);
    if (score.failed > 0) failing.push_back(fmt::format("{} ({} of {})", name, score.failed, score.compared));
  }
  return fmt::format(
      "<dl>\n<dt>Every case within {}</dt><dd>{}</dd>\n<dt>Median error above {}</dt><dd>{}</dd>\n"
      "<dt>Cases that fail</dt><dd>{}</dd>\n</dl>\n",
      tolerance_text(), joined(good),
      quantity_text(10 * kSiteTolerance, "m") + " or " + quantity_text(10 * kSiteTolerance, "rad"), joined(bad),
      joined(failing));
}

std::string family_rows(const SiteData& data, std::size_t run) {
  std::string rows;
  std::vector<std::string> scopes = {""};
  if (data.families.size() > 1) scopes.insert(scopes.end(), data.families.begin(), data.families.end());
  for (std::size_t i = 0; i < scopes.size(); ++i) {
    const Score score = score_of(data.results, run, scopes[i], data.headline);
    if (score.compared == 0 && score.searched == 0 && score.unsupported == 0) continue;
    const std::string stable = stable_text(score);
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{} of {}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        i == 0 ? "all" : escaped(scopes[i]), score.within, score.compared, score.compared > 0 ? error_text(score) : "–",
        score.failed, score.unsupported, stable.empty() ? "–" : stable);
  }
  return rows;
}

std::string case_rows(const SiteData& data, std::size_t run) {
  std::string rows;
  for (const CaseResult& result : data.results.cases) {
    for (const Cell& cell : result.cells) {
      if (cell.run != run || !(cell.dt == data.headline)) continue;
      const std::string metric = main_error(result);
      const auto error = cell.metrics.find(metric);
      const bool has_error = error != cell.metrics.end() && error->second.not_applicable.empty();
      const std::string value = has_error ? quantity_text(error->second.value, unit_of_metric(metric)) : "–";
      const bool is_own = has_error && error->second.is_held_to_itself;
      rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                          link_to(kRootOfEngines, case_page_address(result.definition.id), result.definition.id),
                          is_own ? "(" + value + ")" : value, escaped(metric),
                          cell.metrics.empty()
                              ? word_of(cell.status)
                              : fmt::format("{}, {}", word_of(cell.status), word_of(cell.stability.verdict)));
    }
  }
  return rows;
}

std::string settings_list(const SiteData& data, std::size_t run) {
  const auto settings = settings_of(data, run);
  if (settings.empty()) return "";
  std::string text = "<details><summary>Settings in force, as read back from the engine</summary>\n<dl>\n";
  for (const auto& [name, values] : settings) {
    std::vector<std::string> shown;
    for (const auto& [value, cells] : values) {
      if (shown.size() == kMostValues) break;
      shown.push_back(values.size() == 1 ? value : fmt::format("{} (in {} cells)", value, cells));
    }
    const std::string more =
        values.size() > kMostValues ? fmt::format(" and {} other values", values.size() - kMostValues) : "";
    text += fmt::format("<dt>{}</dt><dd>{}{}</dd>\n", escaped(name), escaped(fmt::format("{}", fmt::join(shown, "; "))),
                        more);
  }
  return text + "</dl></details>\n";
}

std::string run_section(const SiteData& data, const EngineRuns& engine, std::size_t run) {
  const RunName& name = data.results.runs[run];
  std::string text = fmt::format("<section>\n<h2 id=\"{}\">{}</h2>\n", safe_name(name.text), escaped(name.text));
  text +=
      table_with(name.text + ", by family",
                 {"family", "within " + tolerance_text(), "median error", "failed", "unsupported", "largest stable dt"},
                 family_rows(data, run));
  // Of an engine with many methods, the other cases are in its JSON and in the pages of the cases.
  if (!engine.is_in_house || run == main_run(data.results, engine))
    text +=
        fmt::format("<details><summary>Each case at dt = {} s</summary>\n{}</details>\n", escaped(data.headline.text),
                    table_with(name.text + ", by case", {"case", "error", "metric", "end"}, case_rows(data, run)));
  return text + settings_list(data, run) + "</section>\n";
}

std::string deviations_section(const SiteData& data, const EngineRuns& engine) {
  const std::vector<DeviationRow> deviations = deviations_of(data, engine);
  std::string text = "<section>\n<h2 id=\"deviations\">Known deviations</h2>\n";
  if (deviations.empty()) return text + "<p>None in these results.</p>\n</section>\n";
  std::string rows;
  for (const DeviationRow& row : deviations)
    rows +=
        fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td class=\"text\">{}</td></tr>\n",
                    link_to(kRootOfEngines, case_page_address(row.case_id), row.case_id), escaped(row.run),
                    escaped(row.dt.empty() ? "all" : row.dt),
                    link_to(kRootOfEngines, metric_page_address(row.metric), row.metric), escaped(row.text));
  return text + "<p>Gates that the engine is known not to meet, each with its reason.</p>\n" +
         table_with("Known deviations", {"case", "run", "dt", "gate of", "found, and why"}, rows) + "</section>\n";
}

std::string step_rows(const EngineHistory& history) {
  std::string rows;
  for (std::size_t i = 0; i < std::min(history.steps.size(), kMostSteps); ++i) {
    const ErrorStep& step = history.steps[i];
    rows += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td class=\"{}\">{}</td><td>{} to {}</td><td>{}</td></tr>\n",
        escaped(step.cell), escaped(step.metric), step.is_worse ? "worse" : "better",
        step.is_worse ? "worse" : "better", rounded(step.before), rounded(step.after), escaped(step.at));
  }
  return rows;
}

std::string history_section_of(const EngineHistory& history) {
  std::string text = "<section>\n<h2 id=\"history\">History</h2>\n";
  if (history.entries.size() < 2)
    return text + fmt::format("<p>One version so far{}.</p>\n</section>\n",
                              history.entries.empty() ? "" : ": " + escaped(history.entries.front().commit));
  std::vector<std::string> versions;
  for (const HistoryEntry& entry : history.entries) versions.push_back(entry.commit);
  const auto worse =
      std::count_if(history.steps.begin(), history.steps.end(), [](const auto& s) { return s.is_worse; });
  text += fmt::format(
      "<p>{} entries: {}.</p>\n<p>Errors stepped {} times to the worse and {} times to the better. A red mark in a "
      "picture begins a new level.</p>\n",
      versions.size(), joined(versions), worse, history.steps.size() - static_cast<std::size_t>(worse));
  if (!history.steps.empty())
    text += table_with("Steps of errors", {"cell", "metric", "step", "from, to", "at version"}, step_rows(history));
  if (history.steps.size() > kMostSteps)
    text += fmt::format("<p>{} more are in the JSON.</p>\n", history.steps.size() - kMostSteps);
  for (std::size_t i = 0; i < std::min(history.changed.size(), kMostPictures); ++i)
    text += history_section(history.changed[i], history.entries);
  return text + "</section>\n";
}

}  // namespace

std::string engine_page(const SiteData& data, const EngineRuns& engine, const EngineHistory& history) {
  const std::size_t main = main_run(data.results, engine);
  const RunName& name = data.results.runs[main];
  std::string version, precision;
  for (const EngineInfo& info : data.results.engines)
    if (info.name == engine.engine) version = info.version, precision = info.precision;
  std::string body =
      fmt::format("<h1>{}</h1>\n<p>Version {}, {} precision. <img src=\"{}{}\" alt=\"\" height=\"20\"> {}</p>\n",
                  escaped(engine.engine), escaped(version), escaped(precision), kRootOfEngines,
                  badge_address(name.text), link_to(kRootOfEngines, engine_data_address(engine.engine), "JSON"));
  body += fmt::format("<section>\n<h2 id=\"summary\">What {} is good at, at dt = {} s</h2>\n", escaped(name.text),
                      escaped(data.headline.text)) +
          strengths(data, main) + "</section>\n";
  body += history_section_of(history);
  for (const std::size_t run : engine.runs) body += run_section(data, engine, run);
  body += deviations_section(data, engine);
  return site_page(engine_page_address(engine.engine), "Rigor: " + engine.engine, body);
}

}  // namespace rigor::inline report
