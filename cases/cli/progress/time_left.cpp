#include "cases/cli/progress/time_left.h"

#include <algorithm>
#include <cmath>

namespace rigor::inline cli {
namespace {

// Fitted to 11 runs and gates of the suite, of 50 s to 8 minutes with two jobs.
constexpr double kPerStepOfBody = 6e-6, kPerStepOfJointedBody = 2e-6;       // s
constexpr double kPerCellItself = 0.01;                                     // s
constexpr double kPerSearchItself = 0.1, kPerSearchItselfWithLimits = 0.4;  // s
constexpr double kLeastShare = 0.1, kMostChange = 1.25;
// In the same runs the prediction lay between 0.8 and 1.75 of the truth in nine of ten lines.
constexpr double kTooLong = 1.75, kTooShort = 1.25;
constexpr double kPrior = 1;  // s of predicted work, for which an engine counts as fast as the others

}  // namespace

double predicted_seconds(const Case& definition, const Cell& cell) {
  const auto& bodies = definition.scene.bodies;
  const auto moving = std::count_if(bodies.begin(), bodies.end(), [](const Body& body) { return !body.fixed; });
  const double per_body = definition.scene.joints.empty() ? kPerStepOfBody : kPerStepOfJointedBody;
  return kPerCellItself + definition.duration / cell.dt.seconds * per_body * static_cast<double>(moving);
}

double predicted_search_seconds(const Scene& scene) {
  const bool has_limits =
      std::any_of(scene.joints.begin(), scene.joints.end(), [](const Joint& joint) { return joint.has_limits(); });
  return has_limits ? kPerSearchItselfWithLimits : kPerSearchItself;
}

TimeLeft::TimeLeft(const Results& planned, int jobs, const MeasuredTimes& measured) : jobs_(jobs) {
  for (std::size_t c = 0; c < planned.cases.size(); ++c) {
    const CaseResult& result = planned.cases[c];
    for (std::size_t n = 0; n < result.cells.size(); ++n) {
      const Cell& cell = result.cells[n];
      if (cell.status == Status::unsupported) continue;
      const RunName& run = planned.runs[cell.run];
      const auto before = measured.find({result.definition.id, run.text, cell.dt.text});
      const bool is_measured = before != measured.end();
      const double seconds = is_measured ? before->second : predicted_seconds(result.definition, cell);
      cells_[{c, n}] = {run.engine, seconds, is_measured};
      all_ += seconds;
    }
    for (std::size_t n = 0; n < result.stable_steps.size(); ++n) {
      if (result.stable_steps[n].status == Status::unsupported) continue;
      const double seconds = predicted_search_seconds(result.definition.scene);
      searches_[{c, n}] = {planned.runs[n].engine, seconds};
      all_ += seconds;
    }
  }
}

void TimeLeft::end_cell(std::size_t of_case, std::size_t cell, double wall_seconds) {
  const auto found = cells_.find({of_case, cell});
  if (found == cells_.end() || found->second.took) return;
  found->second.took = wall_seconds, done_ += found->second.predicted;
}

// Nothing measures a search, so it teaches nothing.
void TimeLeft::end_search(std::size_t of_case, std::size_t run) {
  const auto found = searches_.find({of_case, run});
  if (found == searches_.end()) return;
  done_ += found->second.predicted;
  searches_.erase(found);
}

double TimeLeft::remaining() const {
  struct Sums {
    double predicted = 0, took = 0;
  };
  std::map<std::string, Sums> by_engine;
  Sums all;
  for (const auto& [key, part] : cells_) {
    if (!part.took || part.is_measured) continue;
    for (Sums* sums : {&by_engine[part.engine], &all}) sums->predicted += part.predicted, sums->took += *part.took;
  }
  const double common = all.predicted > 0 ? all.took / all.predicted : 1;
  const auto scale_of = [&](const std::string& engine) {
    const auto found = by_engine.find(engine);
    const Sums own = found == by_engine.end() ? Sums() : found->second;
    return (own.took + common * kPrior) / (own.predicted + kPrior);
  };
  double sum = 0;
  for (const auto& [key, part] : cells_) {
    if (!part.took) sum += part.predicted * (part.is_measured ? 1 : scale_of(part.engine));
  }
  for (const auto& [key, part] : searches_) sum += part.predicted * scale_of(part.engine);
  return sum;
}

std::optional<Estimate> TimeLeft::at(double elapsed) {
  const double left = remaining() / jobs_, total = elapsed + left;
  std::optional<double> before;
  for (const auto& [time, predicted] : totals_) {
    if (time <= 0.5 * elapsed) before = predicted;
  }
  if (done_ >= kLeastShare * all_) totals_.emplace_back(elapsed, total);
  if (!before || done_ < kLeastShare * all_) return {};
  if (std::max(total / *before, *before / total) > kMostChange) return {};
  return Estimate{left / kTooLong, left * kTooShort};
}

}  // namespace rigor::inline cli
