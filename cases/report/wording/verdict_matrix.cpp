#include "cases/report/wording/verdict_matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cases/metrics/measures/shape_gap.h"
#include "cases/report/wording/findings/findings.h"
#include "cases/report/wording/wording.h"
#include "cases/results/main_error.h"

namespace rigor::inline report {
namespace {

// Not a number where there is none.
double value_of(const Cell& cell, const std::string& name) {
  const auto found = cell.metrics.find(name);
  return found == cell.metrics.end() || !found->second.not_applicable.empty() ? std::nan("") : found->second.value;
}

bool is_stable(const Cell& cell) { return cell.status == Status::pass && cell.stability.verdict == Verdict::stable; }

std::string error_text(const Cell& cell, const std::string& metric) {
  const double value = value_of(cell, metric);
  if (std::isnan(value)) return "";
  const bool is_length = metric == "position_error", is_angle = metric == "orientation_error";
  const std::string unit = unit_of_metric(metric);
  const bool is_of_recording = metric == "mean_position_error" || metric == "mean_rotation_error";
  const std::string text = is_of_recording         ? fmt::format("{} {}", rounded(value), unit)
                           : is_length || is_angle ? rounded(value) + (is_length ? " m" : " rad")
                                                   : rounded(100 * value) + " %";
  return cell.metrics.at(metric).is_held_to_itself ? fmt::format(" ({})", text) : " " + text;
}

std::string cell_text(const Cell& cell, const std::string& metric, Words words) {
  if (words == Words::few && is_stable(cell) && !cell.metrics.empty()) return sign_of(cell) + error_text(cell, metric);
  if (words == Words::few && cell.status == Status::unsupported) return sign_of(cell);
  std::string word = word_of(cell.status);
  if (cell.status == Status::diverged) return sign_of(cell) + " " + phrase_of(cell.stability);
  if (cell.status == Status::pass && !cell.metrics.empty()) word = phrase_of(cell.stability);
  return fmt::format("{} {}{}", sign_of(cell), word, error_text(cell, metric));
}

std::string sign_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::stable:
      return "✓";
    case Verdict::drifting:
      return "≈";
    case Verdict::overlapping:
      return "∩";
    case Verdict::gaining:
      return "↑";
    case Verdict::collapsed:
      return "↓";
    case Verdict::tunnelled:
      return "»";
    case Verdict::blown_up:
      return "✕";
  }
  return "!";
}

}  // namespace

std::string sign_of(const Cell& cell) {
  switch (cell.status) {
    case Status::pass:
      return is_stable(cell) && cell.reduced_order ? "◐" : sign_of(cell.stability.verdict);
    case Status::diverged:
    case Status::fail:
      return "✕";
    case Status::unsupported:
      return "–";
    case Status::known_deviation:
      return "◆";
    case Status::unexpected_pass:
      return "◇";
    default:
      return "!";
  }
}

double size_of(const Scene& scene) {
  double size = 0;
  Vec3 low = Vec3::Constant(HUGE_VAL), high = -low;
  for (const Body& body : scene.bodies) {
    if (body.fixed) continue;
    low = low.cwiseMin(body.position), high = high.cwiseMax(body.position);
    size = std::max(
        size, 2 * (body.shape ? bounding_radius(*body.shape) : std::sqrt(0.5 * body.inertia.trace() / body.mass)));
  }
  for (const Spring& spring : scene.springs) size = std::max(size, spring.rest_length);
  return low.x() <= high.x() ? std::max(size, (high - low).norm()) : size;
}

std::string shade_of(const CaseResult& result, const Cell& cell) {
  const double share = main_error(result) == "orientation_error"
                           ? value_of(cell, "orientation_error")
                           : value_of(cell, "position_error") / size_of(result.definition.scene);
  if (cell.status == Status::diverged || !(share >= 1e-3)) return " ";
  return share < 1e-2 ? "░" : share < 1e-1 ? "▒" : share < 1 ? "▓" : "█";
}

std::vector<std::size_t> readable_columns(const Results& results, const std::vector<std::size_t>& runs) {
  if (runs.size() <= kMostMatrixColumns) return runs;
  std::vector<std::size_t> firsts;
  for (const std::size_t run : runs) {
    const auto is_of_its_engine = [&](std::size_t other) {
      return results.runs[other].engine == results.runs[run].engine;
    };
    if (std::none_of(firsts.begin(), firsts.end(), is_of_its_engine)) firsts.push_back(run);
  }
  return firsts;
}

TextTable verdict_matrix(const Results& results, Words words) {
  std::vector<std::size_t> runs(results.runs.size());
  std::iota(runs.begin(), runs.end(), std::size_t{0});
  return verdict_matrix(results, words, runs);
}

TextTable verdict_matrix(const Results& results, Words words, const std::vector<std::size_t>& runs) {
  const StepSize headline = headline_dt(results);
  TextTable matrix{
      fmt::format("dt = {} s: the verdict, and the largest error of the position [m]; of the orientation "
                  "[rad] where nothing moves away; of the energy [%] where there is no truth; in "
                  "brackets, of a truth that the run's own code makes. The darker "
                  "the square, the larger the error in sizes of the case or in rad: ░ from 1e-3, ▒ 1e-2, "
                  "▓ 1e-1, █ 1{}",
                  headline.text,
                  words == Words::few ? ". ✓: stable; ◐: stable, in part at a lower order; –: unsupported" : ""),
      {{"case"}}};
  for (const std::size_t run : runs) matrix.rows[0].push_back(results.runs[run].text);
  for (const CaseResult& result : results.cases) {
    const StepSize dt = matrix_dt(result, headline);
    std::vector<std::string> row(runs.size() + 1, "");
    row[0] = result.definition.id + (dt == headline ? "" : fmt::format(" (dt {})", dt.text));
    const std::string metric = main_error(result);
    for (const Cell& cell : result.cells) {
      const auto column = std::find(runs.begin(), runs.end(), cell.run);
      if (cell.dt != dt || column == runs.end()) continue;
      const std::string shade = shade_of(result, cell);
      row[static_cast<std::size_t>(column - runs.begin()) + 1] =
          cell_text(cell, metric, words) + (shade == " " ? "" : " " + shade);
    }
    matrix.rows.push_back(row);
  }
  return matrix;
}

}  // namespace rigor::inline report
