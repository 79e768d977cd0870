#include "cases/report/site/score.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "cases/analysis/cell_error.h"

namespace rigor::inline report {
namespace {

bool is_of_family(const CaseResult& result, const std::string& family) {
  return family.empty() || family_of(result.definition.id) == family;
}

// Infinite for a cell that failed; none where there is nothing to compare.
std::optional<double> error_of(const CaseResult& result, const Cell& cell, const std::string& metric) {
  const MainErrorOfCell error = main_error_of(result, cell, metric);
  if (error.kind == MainErrorOfCell::Kind::none) return {};
  const bool has_failed = error.kind == MainErrorOfCell::Kind::failed || is_wrong_as_a_whole(cell);
  return has_failed ? std::numeric_limits<double>::infinity() : error.value;
}

void add_stable(const StableStepResult& found, Score& score) {
  if (found.status != Status::pass || found.skipped) return;
  ++score.searched;
  if (!score.stable || found.step.dt < score.stable->dt) score.stable = found.step;
}

}  // namespace

Score score_of(const Results& results, std::size_t run, const std::string& family, const StepSize& headline) {
  Score score;
  std::vector<double> errors;
  std::size_t angles = 0;
  for (const CaseResult& result : results.cases) {
    if (!is_of_family(result, family)) continue;
    add_stable(result.stable_steps[run], score);
    const bool is_compared = has_main_error_of_truth(result);
    const std::string metric = main_error(result);
    for (const Cell& cell : result.cells) {
      if (cell.run != run || !(cell.dt == headline)) continue;
      if (cell.status == Status::unsupported) ++score.unsupported;
      const std::optional<double> error = is_compared ? error_of(result, cell, metric) : std::nullopt;
      if (!error) continue;
      errors.push_back(*error);
      angles += metric == "orientation_error";
    }
  }
  score.compared = errors.size();
  if (angles > 0) score.unit = angles == errors.size() ? "rad" : "m or rad";
  for (const double error : errors) score.within += error <= kSiteTolerance, score.failed += !std::isfinite(error);
  std::sort(errors.begin(), errors.end());
  if (!errors.empty()) score.median = errors[errors.size() / 2];
  return score;
}

std::optional<int> level_of(const Score& score) {
  if (score.compared == 0 || !std::isfinite(score.median)) return {};
  // The rounding of a decimal tolerance stays below the margin.
  const double decades = std::log10(std::max(score.median, 1e-300) / kSiteTolerance) - 1e-9;
  return static_cast<int>(std::clamp(std::ceil(decades) + 2, 0.0, 5.0));
}

std::string family_of(const std::string& case_id) {
  const std::size_t slash = case_id.rfind('/');
  return slash == std::string::npos ? "" : case_id.substr(0, slash);
}

std::vector<std::string> families_of(const Results& results) {
  std::set<std::string> found;
  for (const CaseResult& result : results.cases) found.insert(family_of(result.definition.id));
  return {found.begin(), found.end()};
}

bool is_stock(const RunName& run) { return run.text.ends_with("@stock"); }

std::vector<EngineRuns> engines_of(const Results& results) {
  std::vector<EngineRuns> found;
  for (std::size_t run = 0; run < results.runs.size(); ++run) {
    const std::string& name = results.runs[run].engine;
    auto engine = std::find_if(found.begin(), found.end(), [&](const EngineRuns& one) { return one.engine == name; });
    if (engine == found.end()) engine = found.insert(engine, {name, is_in_house(results, run), {}});
    engine->runs.push_back(run);
  }
  std::stable_partition(found.begin(), found.end(), [](const EngineRuns& engine) { return !engine.is_in_house; });
  return found;
}

std::size_t main_run(const Results& results, const EngineRuns& engine) {
  for (const std::size_t run : engine.runs)
    if (results.runs[run].text == engine.engine) return run;
  return engine.runs.front();
}

}  // namespace rigor::inline report
