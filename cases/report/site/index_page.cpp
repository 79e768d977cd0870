// index.html: engines by families, then lists of all pages.
#include <fmt/format.h>

#include <algorithm>

#include "cases/report/html/svg.h"
#include "cases/report/site/addresses.h"
#include "cases/report/site/site_pages.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

std::string family_label(const std::string& family) { return family.empty() ? "cases" : family; }

std::string matrix_cell_of(const SiteData& data, std::size_t run, const std::string& family) {
  const Score score = score_of(data.results, run, family, data.headline);
  const std::string stable = stable_text(score);
  const std::string below = stable.empty() ? "" : fmt::format("<span>stable {}</span>", stable);
  if (score.compared == 0) {
    const bool is_refused = score.unsupported > 0 && score.searched == 0;
    return fmt::format("<td class=\"none\">{}{}</td>", is_refused ? "unsupported" : "–", below);
  }
  const std::optional<int> level = level_of(score);
  return fmt::format("<td class=\"{}\"><b>{}</b><span>{} of {}{}</span>{}</td>",
                     level ? fmt::format("level-{}", *level) : "failed", error_text(score), score.within,
                     score.compared, score.failed > 0 ? fmt::format(", {} failed", score.failed) : "", below);
}

std::string matrix_row_of(const SiteData& data, std::size_t run) {
  const RunName& name = data.results.runs[run];
  std::string text = fmt::format("<tr><th scope=\"row\"><a href=\"{}#{}\">{}</a></th>",
                                 engine_page_address(name.engine), safe_name(name.text), escaped(name.text));
  text += matrix_cell_of(data, run, "");
  if (data.families.size() > 1)
    for (const std::string& family : data.families) text += matrix_cell_of(data, run, family);
  return text + "</tr>\n";
}

std::string matrix_of(const SiteData& data, const std::vector<std::size_t>& runs, const std::string& caption) {
  std::string text = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{0}\">\n<table class=\"matrix\">\n"
      "<caption>{0}</caption>\n<thead><tr><th scope=\"col\">run</th><th scope=\"col\">all</th>",
      escaped(caption));
  if (data.families.size() > 1)
    for (const std::string& family : data.families)
      text += fmt::format("<th scope=\"col\">{}</th>", escaped(family_label(family)));
  text += "</tr></thead>\n<tbody>\n";
  for (const std::size_t run : runs) text += matrix_row_of(data, run);
  return text + "</tbody>\n</table>\n</div>\n";
}

// Runs with cells in fewer than half of the cases stand apart: their numbers are about other cases.
bool is_rare(const SiteData& data, std::size_t run) {
  std::size_t cases = 0;
  for (const CaseResult& result : data.results.cases)
    cases += std::any_of(result.cells.begin(), result.cells.end(), [&](const Cell& cell) { return cell.run == run; });
  return 2 * cases < data.results.cases.size();
}

std::string legend() {
  std::string text = "<p class=\"legend\">Median error against " + tolerance_text() + ": ";
  constexpr const char* kLevels[] = {"≤ 1/100", "≤ 1/10", "within", "≤ 10 ×", "≤ 100 ×", "more"};
  for (int level = 0; level < 6; ++level)
    text += fmt::format("<span class=\"level-{}\">{}</span> ", level, kLevels[level]);
  return text + "<span class=\"failed\">failed</span></p>\n";
}

std::string engine_list(const SiteData& data) {
  std::string text = "<h2 id=\"engines\">Engines</h2>\n<ul class=\"engines\">\n";
  for (const EngineRuns& engine : data.engines) {
    const std::size_t run = main_run(data.results, engine);
    text += fmt::format("<li>{} <img src=\"{}\" alt=\"\" height=\"20\"></li>\n",
                        link_to("", engine_page_address(engine.engine), engine.engine),
                        badge_address(data.results.runs[run].text));
  }
  return text + "</ul>\n";
}

std::string case_list(const SiteData& data) {
  std::string text = "<h2 id=\"cases\">Cases</h2>\n";
  for (const std::string& family : data.families) {
    text += fmt::format("<h3>{}</h3>\n<ul class=\"cases\">\n", escaped(family_label(family)));
    for (const CaseResult& result : data.results.cases) {
      const Case& definition = result.definition;
      if (family_of(definition.id) != family) continue;
      const std::string name = family.empty() ? definition.id : definition.id.substr(family.size() + 1);
      text += fmt::format("<li>{}: {}</li>\n", link_to("", case_page_address(definition.id), name),
                          escaped(definition.title));
    }
    text += "</ul>\n";
  }
  return text;
}

std::string metric_list(const SiteData& data) {
  std::string text = "<h2 id=\"metrics\">Metrics</h2>\n<ul class=\"metrics\">\n";
  for (const Json& metric : data.merged.results.at("metrics")) {
    const std::string name = metric.at("name").get<std::string>();
    text += fmt::format("<li>{}: {}</li>\n", link_to("", metric_page_address(name), name),
                        escaped(metric.at("summary").get<std::string>()));
  }
  return text + "</ul>\n";
}

}  // namespace

std::string index_page(const SiteData& data) {
  std::vector<std::size_t> usual, rare;
  for (const EngineRuns& engine : data.engines)
    for (const std::size_t run : engine.runs) (is_rare(data, run) ? rare : usual).push_back(run);
  std::string body = fmt::format(
      "<h1>How accurate are {} engines?</h1>\n<p>{} cases with {} methods and settings. Each field holds the median "
      "error at dt = {} s, how many cases stay within {}, and the largest dt at which every case is stable. A case "
      "counts if its truth is independent of the run.</p>\n",
      data.engines.size(), data.results.cases.size(), data.results.runs.size(), escaped(data.headline.text),
      tolerance_text());
  body += legend();
  if (!usual.empty()) body += matrix_of(data, usual, fmt::format("Errors at dt = {} s", data.headline.text));
  if (!rare.empty())
    body += "<details><summary>Runs that fewer than half of the cases have</summary>\n" +
            matrix_of(data, rare, "Runs of some cases") + "</details>\n";
  body += engine_list(data) + case_list(data) + metric_list(data);
  return site_page("index.html", "Rigor: how accurate engines are", body);
}

}  // namespace rigor::inline report
