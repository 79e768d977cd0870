// The files of the site, each as text. Only the page of a case runs a script, the site's own page.js.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "cases/report/site/engine_history.h"
#include "cases/report/site/site_data.h"
#include "core/base/json_fwd.h"

namespace rigor::inline report {

std::string index_page(const SiteData& data);
std::string engine_page(const SiteData& data, const EngineRuns& engine, const EngineHistory& history);
std::string case_page(const SiteData& data, const std::string& case_id, const Json& shown);
std::string metric_page(const SiteData& data, const Json& metric);
std::string badge_of(const SiteData& data, std::size_t run);

// The same as JSON; cases/docs/guides/site.md describes it.
Json index_data(const SiteData& data);
Json engine_data(const SiteData& data, const EngineRuns& engine, const EngineHistory& history);
Json case_data(const SiteData& data, const Json& of_results, std::size_t of_case);

// Parts of a results.json, one for each case, in the form of a results.json and in the order of the cases.
std::vector<Json> parts_by_case(const Json& results);

// A whole page at this address of the site, without a script.
std::string site_page(const std::string& address, const std::string& title, const std::string& body);

// The start of every page's head. `policy`: the page's own sources.
std::string site_head(const std::string& title, const std::string& policy);

std::string link_to(const std::string& root, const std::string& address, const std::string& text);
std::string error_text(const Score& score);   // "16 mm", "16 mm or mrad", "failed"
std::string stable_text(const Score& score);  // "≥ 100 ms"; empty if none was found
std::string tolerance_text();                 // "1 mm or 1 mrad"

// A failure that the adapter's known_deviations.toml explains.
struct DeviationRow {
  std::string case_id, run, dt, metric, text;
};
std::vector<DeviationRow> deviations_of(const SiteData& data, const EngineRuns& engine);

// The settings in force of a run: each value, and in how many cells it was in force.
std::map<std::string, std::map<std::string, std::size_t>> settings_of(const SiteData& data, std::size_t run);

}  // namespace rigor::inline report
