// metrics/METRIC.html: what it measures, and what each run has of it at the headline's step.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/report/html/svg.h"
#include "cases/report/site/addresses.h"
#include "cases/report/site/site_pages.h"
#include "cases/report/wording/wording.h"
#include "core/base/json.h"

namespace rigor::inline report {
namespace {

constexpr const char* kRootOfMetrics = "../";

struct MetricOfRun {
  std::vector<double> sizes;
  double worst = -1;
  std::string worst_case;
};

// Values that are held to a truth of the run's own code are left out.
MetricOfRun values_of(const SiteData& data, std::size_t run, const std::string& metric, bool is_higher_better) {
  MetricOfRun found;
  for (const CaseResult& result : data.results.cases) {
    for (const Cell& cell : result.cells) {
      const auto value = cell.metrics.find(metric);
      if (cell.run != run || !(cell.dt == data.headline) || value == cell.metrics.end()) continue;
      if (!value->second.not_applicable.empty() || value->second.is_held_to_itself) continue;
      const double size = std::abs(value->second.value);
      const bool is_worst =
          found.sizes.empty() || std::isnan(size) || (is_higher_better ? size < found.worst : size > found.worst);
      if (is_worst) found.worst = size, found.worst_case = result.definition.id;
      found.sizes.push_back(std::isnan(size) ? HUGE_VAL : size);
    }
  }
  std::sort(found.sizes.begin(), found.sizes.end());
  return found;
}

std::string needs_of(const MetricNeeds& needs) {
  std::vector<std::string> parts;
  if (needs.truth) parts.push_back("a truth");
  if (needs.twin) parts.push_back("a scheme replica (twin)");
  if (needs.ensemble) parts.push_back("an ensemble of runs");
  if (needs.contacts) parts.push_back("the contact forces that the engine reports");
  if (needs.reactions) parts.push_back("the joint reactions that the engine reports");
  return parts.empty() ? "the run alone" : fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

std::string metric_page(const SiteData& data, const Json& metric) {
  const std::string name = metric.at("name").get<std::string>(), unit = metric.at("unit").get<std::string>();
  const MetricRow* known = find_metric(name);
  const bool is_higher_better = known && known->higher_is_better;
  std::string body = fmt::format(
      "<h1>{}</h1>\n<p>{}</p>\n<dl>\n<dt>Unit</dt><dd>{}</dd>\n<dt>Better</dt><dd>{}</dd>\n<dt>Needs</dt><dd>{}</dd>\n"
      "</dl>\n",
      escaped(name), escaped(metric.at("summary").get<std::string>()), escaped(unit),
      is_higher_better ? "higher" : "lower", known ? needs_of(known->needs) : "unknown to this version of Rigor");
  std::string rows;
  for (const EngineRuns& engine : data.engines) {
    for (const std::size_t run : engine.runs) {
      const MetricOfRun found = values_of(data, run, name, is_higher_better);
      if (found.sizes.empty()) continue;
      const std::string shown_unit = unit == "1" ? "" : unit;
      rows += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
                          link_to(kRootOfMetrics, engine_page_address(engine.engine), data.results.runs[run].text),
                          found.sizes.size(), escaped(quantity_text(found.sizes[found.sizes.size() / 2], shown_unit)),
                          escaped(quantity_text(found.worst, shown_unit)),
                          link_to(kRootOfMetrics, case_page_address(found.worst_case), found.worst_case));
    }
  }
  body += fmt::format("<h2>At dt = {} s</h2>\n", escaped(data.headline.text));
  if (rows.empty())
    body += "<p>No run has a value of it.</p>\n";
  else
    body +=
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"Values by run\">\n<table class=\"plain\">\n"
        "<thead><tr><th scope=\"col\">run</th><th scope=\"col\">cases</th><th scope=\"col\">median</th><th "
        "scope=\"col\">worst</th><th scope=\"col\">in case</th></tr></thead>\n<tbody>\n" +
        rows + "</tbody>\n</table>\n</div>\n";
  return site_page(metric_page_address(name), "Rigor: " + name, body);
}

}  // namespace rigor::inline report
