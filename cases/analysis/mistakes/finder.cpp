#include "cases/analysis/mistakes/finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "adapters/faults/faults.h"

namespace rigor {
namespace {

// From here on a mistake is said to be what the error looks like; below, none is. What a mistake leaves is a root mean
// square, so that 0.15 is one observation in forty-four wholly unexplained, or each to 0.15: what an engine does
// otherwise where bodies touch comes to that in a tenth of the observations at their weight. Not derived further: set
// with the table's own mistakes in ODE; tests/cases/analysis/mistakes_test.cpp asks it of amounts, engines and pairs
// that had no part in it.
constexpr double kNamed = 0.85;
constexpr double kSure =
    0.999;  // nothing better is looked for: a thousandth is left by rounding alone in chaotic cases
constexpr double kAlike = 1e-3;  // suspects that explain as much, to within this part of what is left of 1
constexpr std::size_t kShown = 5;
constexpr double kMostOfMistake = 0.5;  // s of CPU time: some mistakes make scenes on which the core works for long
constexpr double kNotable = 0.3;

std::vector<Hypothesis> of_table() {
  std::vector<Hypothesis> all;
  for (const Fault& fault : faults()) all.push_back({std::make_shared<Fault>(fault), {fault.name}, {}});
  return all;
}

// An engine that gets its loads from Rigor, by wrenches, gets them worked out from what it tells: what it tells wrongly
// moves it otherwise too, by which its motion is not the mistake's alone. Before the first step no load has had a
// share.
bool is_fed_back(const Fault& fault, const Scene& scene, const EngineInfo& engine) {
  const bool tells_wrongly = fault.read || fault.reads_late;
  return tells_wrongly && engine.features.contains("wrench") && !(scene.springs.empty() && scene.forces.empty());
}

Hypothesis pair_of(const Hypothesis& first, const Hypothesis& second) {
  return {std::make_shared<Fault>(combined(*first.fault, *second.fault)), {first.names[0], second.names[0]}, {}};
}

}  // namespace

MistakeFinder::MistakeFinder(const EngineTable& engines, RunName run, std::vector<ProbeScene> probes, Options options)
    : engines_(engines), run_(std::move(run)), probes_(std::move(probes)), options_(options) {}

// Of the engine by its own settings, where `engine` is one; else of each view's base.
std::vector<Sight> MistakeFinder::sights(const Table& table, const Engine* engine,
                                         std::shared_ptr<const Fault> fault) const {
  std::vector<MotionTask> tasks;
  for (const View& view : table.views) {
    const Engine& moved = engine ? *engine : engines_.find(view.base.engine);
    const Settings& settings = engine ? run_.settings : view.base.settings;
    for (MotionTask& task : tasks_of(view, probes_[view.probe], moved, settings, fault))
      tasks.push_back(std::move(task));
  }
  const std::vector<StateSeries> motions = simulate_motions(tasks, engines_, options_.at_once, options_.limit);
  std::vector<Sight> out;
  std::size_t at = 0;
  for (const View& view : table.views) out.push_back(seen(view, motions, at)), at += view.dt.size();
  return out;
}

// A mistake may make a motion chaotic, in which the engine and its twin with the same mistake part by roundings alone.
void MistakeFinder::add_chaos(const Table& table, const Engine& engine, std::vector<Sight>& moved) const {
  std::vector<MotionTask> tasks;
  std::vector<std::size_t> of;  // the tasks' views
  for (std::size_t v = 0; v < table.views.size(); ++v) {
    const View& view = table.views[v];
    if (view.kind != View::Kind::twin || !moved[v].why.empty()) continue;
    for (MotionTask& task : nudged_tasks(tasks_of(view, probes_[view.probe], engine, run_.settings, nullptr)))
      tasks.push_back(std::move(task)), of.push_back(v);
  }
  const std::vector<StateSeries> motions = simulate_motions(tasks, engines_, options_.at_once, options_.limit);
  for (std::size_t n = 0; n < of.size(); ++n) moved[of[n]].coarse = motions[n].states;
}

std::vector<Hypothesis> MistakeFinder::simulated(const Table& table, std::vector<Hypothesis> hypotheses) const {
  std::vector<MotionTask> tasks;
  for (const Hypothesis& hypothesis : hypotheses) {
    for (const View& view : table.views) {
      for (MotionTask& task :
           tasks_of(view, probes_[view.probe], engines_.find(view.base.engine), view.base.settings, hypothesis.fault))
        tasks.push_back(std::move(task));
    }
  }
  const std::vector<StateSeries> motions = simulate_motions(tasks, engines_, options_.at_once, kMostOfMistake);
  const EngineInfo& engine = engines_.info_of(run_.engine);
  std::size_t at = 0;
  for (Hypothesis& hypothesis : hypotheses) {
    for (const View& view : table.views) {
      const bool is_left_out = is_fed_back(*hypothesis.fault, *probes_[view.probe].scene, engine);
      hypothesis.sights.push_back(seen(view, motions, at));
      hypothesis.sights.back().as_loaded_alone = is_left_out;
      at += view.dt.size();
    }
  }
  return hypotheses;
}

const MistakeFinder::Table& MistakeFinder::table_for(const RunName* of_points) {
  const std::string key = of_points ? of_points->text : "";
  if (const auto found = tables_.find(key); found != tables_.end()) return found->second;
  Table table;
  table.views = views_of(engines_, run_, probes_, of_points);
  table.bases = sights(table, nullptr, nullptr);
  table.observations = observations_of(table.views, table.bases, probes_);
  table.hypotheses = simulated(table, of_table());
  return tables_.emplace(key, std::move(table)).first->second;  // whole, or not at all
}

// The method of the core that steps points as the engine does: of most of the probes of points, for few are off.
RunName MistakeFinder::nearest_method(const Engine& engine) {
  RunName best;
  double least = std::numeric_limits<double>::infinity();
  for (const char* name : {"core:semi-implicit-euler,orientation=quaternion-exponential",
                           "core:semi-implicit-euler,orientation=quaternion-additive", "core:explicit-euler",
                           "core:velocity-verlet", "core:implicit-midpoint"}) {
    Table one;
    const RunName candidate = parse_run_name(name, engines_.infos());
    for (const View& view : views_of(engines_, run_, probes_, &candidate)) {
      if (view.kind == View::Kind::same_method) one.views.push_back(view);
    }
    one.bases = sights(one, nullptr, nullptr);
    const std::vector<Sight> moved = sights(one, &engine, nullptr);
    std::vector<double> errors;
    for (const Observation& observation : observations_of(one.views, one.bases, probes_)) {
      const Sight& sight = moved[observation.view_index()];
      if (sight.why.empty()) errors.push_back(observation.distances(sight, sight).error);
    }
    if (errors.empty()) continue;
    std::nth_element(errors.begin(), errors.begin() + static_cast<long>(errors.size() / 2), errors.end());
    if (const double median = errors[errors.size() / 2]; median < least) least = median, best = candidate;
  }
  return best;
}

// A mistake whose motion has the shape of the error is tried by other amounts.
void MistakeFinder::add_amounts(const Trace& trace, const Table& table, std::vector<Hypothesis>& hypotheses) const {
  constexpr double kSameShape = 0.7;  // the cosine; the amounts of a nonlinear one are found by trying again
  constexpr int kRounds = 4, kMost = 3;
  std::vector<std::pair<double, Hypothesis>> found;
  for (const Hypothesis& hypothesis : table.hypotheses) {
    if (!hypothesis.fault->by) continue;
    const double cosine = std::abs(trace.fit(hypothesis).cosine);  // too little of it is too much by a negative amount
    if (cosine > kSameShape) found.emplace_back(cosine, hypothesis);
  }
  std::sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  found.resize(std::min<std::size_t>(found.size(), kMost));
  for (int round = 0; round < kRounds; ++round) {
    std::vector<Hypothesis> next;
    for (const auto& [cosine, hypothesis] : found) {
      const double amount = trace.fit(hypothesis).factor * hypothesis.fault->amount;
      if (amount == 0) continue;
      const auto fault = std::make_shared<Fault>(hypothesis.fault->by(amount));
      next.push_back({fault, {fault->name}, {}});
    }
    next = simulated(table, std::move(next));
    found.clear();
    for (Hypothesis& hypothesis : next) found.emplace_back(0, std::move(hypothesis));
  }
  for (auto& [cosine, hypothesis] : found) {
    const auto is_same = [&](const Hypothesis& other) { return other.names == hypothesis.names; };
    if (std::none_of(hypotheses.begin(), hypotheses.end(), is_same)) hypotheses.push_back(std::move(hypothesis));
  }
}

// Two mistakes in one engine: those that explain different cases whole, those whose motions add up to the error's, and
// the best one alone with any other.
void MistakeFinder::add_pairs(const Trace& trace, const Table& table, std::vector<Hypothesis>& hypotheses) const {
  constexpr std::size_t kMostTried = 24;
  const std::vector<Hypothesis>& all = table.hypotheses;
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  std::vector<std::pair<std::size_t, std::pair<std::size_t, std::size_t>>> covers;
  std::vector<std::set<std::size_t>> explained;
  for (const Hypothesis& hypothesis : all) {
    const auto own = trace.explained_by(hypothesis, all);
    explained.emplace_back(own.begin(), own.end());
  }
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = i + 1; j < all.size() && !explained[i].empty(); ++j) {
      std::set<std::size_t> both = explained[i];
      both.insert(explained[j].begin(), explained[j].end());
      if (both.size() > std::max(explained[i].size(), explained[j].size())) covers.push_back({both.size(), {i, j}});
    }
  }
  std::stable_sort(covers.begin(), covers.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (std::size_t n = 0; n < std::min(kMostTried, covers.size()); ++n) pairs.insert(covers[n].second);
  const std::vector<Trace::Sum> sums = trace.sums(all);
  for (std::size_t n = 0; n < std::min(kMostTried, sums.size()); ++n) pairs.insert({sums[n].first, sums[n].second});
  const std::vector<Suspect> alone = trace.ranked(all, probes_);
  for (std::size_t other = 0; other < all.size() && !alone.empty(); ++other) {
    if (other != alone.front().hypothesis) pairs.insert(std::minmax(alone.front().hypothesis, other));
  }
  std::vector<Hypothesis> tried;
  for (const auto& [i, j] : pairs) tried.push_back(pair_of(all[i], all[j]));
  for (Hypothesis& hypothesis : simulated(table, std::move(tried))) hypotheses.push_back(std::move(hypothesis));
}

MistakeReport MistakeFinder::report(const Engine& engine) {
  const bool is_single = engines_.info_of(run_.engine).precision == "single";
  const RunName* of_points = nullptr;
  RunName method;
  if (needs_same_method(views_of(engines_, run_, probes_, nullptr))) {
    method = nearest_method(engine);
    if (!method.text.empty()) of_points = &method;
  }
  const Table& table = table_for(of_points);
  MistakeReport report;
  report.known = faults().size();
  std::vector<Sight> moved = sights(table, &engine, nullptr);
  add_chaos(table, engine, moved);
  for (std::size_t v = 0; v < moved.size(); ++v) {
    const std::string& id = probes_[table.views[v].probe].id;
    if (!moved[v].why.empty()) {
      report.failures.push_back(fmt::format("{}: {}", id, moved[v].why));
    } else if (report.seen.empty() || report.seen.back() != id) {
      report.seen.push_back(id);
    }
  }
  std::set<std::string> beside;
  for (const View& view : table.views) beside.insert(view.base.text);
  for (const std::string& name : beside) report.beside += (report.beside.empty() ? "" : ", ") + name;
  if (report.seen.empty()) return report.verdict = MistakeReport::Verdict::untried, report;
  const Trace trace(table.views, table.observations, std::move(moved), is_single);
  std::vector<Hypothesis> hypotheses = table.hypotheses;
  const auto best = [&] {
    const auto ranked = trace.ranked(hypotheses, probes_);
    return ranked.empty() ? 0.0 : ranked.front().explains;
  };
  if (trace.probes_off(hypotheses).empty()) return report;
  if (best() < kSure) add_amounts(trace, table, hypotheses);
  if (best() < kSure) add_pairs(trace, table, hypotheses);
  for (const std::size_t probe : trace.probes_off(hypotheses)) report.off.push_back(probes_[probe].id);
  const std::vector<Suspect> ranked = trace.ranked(hypotheses, probes_);
  for (const Suspect& suspect : ranked) {
    if (report.suspects.size() == kShown || suspect.explains < kNotable) break;
    report.suspects.push_back(
        {hypotheses[suspect.hypothesis].names, suspect.explains, suspect.explained, suspect.cases});
  }
  report.verdict = MistakeReport::Verdict::unnamed;
  if (ranked.empty() || ranked.front().explains < kNamed) return report;
  const double rest = 1 - ranked.front().explains;
  for (const auto& suspect : report.suspects) report.leaders += 1 - suspect.explains <= rest + kAlike * (rest + 1e-6);
  report.verdict = report.leaders > 1 ? MistakeReport::Verdict::alike : MistakeReport::Verdict::named;
  return report;
}

}  // namespace rigor
