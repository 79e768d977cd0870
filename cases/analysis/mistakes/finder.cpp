#include "cases/analysis/mistakes/finder.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "adapters/faults/faults.h"

namespace rigor::inline analysis {
namespace {

// A mistake is named if it explains at least this share. The rest is a root mean square: 0.15 is one observation in
// forty-four without any explanation, or 15 % of each. Contacts leave as much in a tenth of the observations. The value
// was set with the table's own mistakes in ODE. tests/cases/analysis/mistakes_test.cpp checks it with amounts, engines
// and pairs that had no part in the choice.
constexpr double kNamed = 0.85;
constexpr double kSure = 0.999;  // the search ends here: rounding alone leaves a thousandth in chaotic cases
constexpr double kAlike = 1e-3;  // suspects are alike if their rests differ by less than this share
constexpr std::size_t kShown = 5;
constexpr double kMostOfMistake = 0.5;  // s of CPU time: some mistakes make scenes that take the core very long
constexpr double kNotable = 0.3;
constexpr double kMostTimes = 1000;  // of its amount in the table, by which a mistake is enlarged

// Some engines get their loads as wrenches, which Rigor computes from the state that the engine reports. A wrong report
// then also changes the motion. Such a mistake is compared in the loaded state alone, before any load acts.
bool is_fed_back(const Fault& fault, const Scene& scene, const EngineInfo& engine) {
  const bool tells_wrongly = fault.read || fault.reads_late;
  return tells_wrongly && engine.features.contains(Feature::wrench) && !(scene.springs.empty() && scene.forces.empty());
}

}  // namespace

MistakeFinder::MistakeFinder(const EngineTable& engines, RunName run, std::vector<ProbeScene> probes, Options options)
    : engines_(engines), run_(std::move(run)), probes_(std::move(probes)), options_(options) {}

std::vector<StateSeries> MistakeFinder::motions_of(const std::vector<MotionTask>& tasks, double limit) const {
  return simulate_motions(tasks, engines_, options_.at_once, limit, [this] {
    ++motions_;
    if (options_.on_motions) options_.on_motions(motions_);
  });
}

// The sights of `engine` with the run's settings; if it is null, those of each view's base.
std::vector<Sight> MistakeFinder::sights(const MistakeTable& table, const Engine* engine,
                                         std::shared_ptr<const Fault> fault) const {
  std::vector<MotionTask> tasks;
  for (const View& view : table.views) {
    const Engine& moved = engine ? *engine : engines_.find(view.base.engine);
    const Settings& settings = engine ? run_.settings : view.base.settings;
    for (MotionTask& task : tasks_of(view, probes_[view.probe], moved, settings, fault))
      tasks.push_back(std::move(task));
  }
  const std::vector<StateSeries> motions = motions_of(tasks, options_.limit);
  std::vector<Sight> out;
  std::size_t at = 0;
  for (const View& view : table.views) out.push_back(seen(view, motions, at)), at += view.dt.size();
  return out;
}

// A mistake may make a motion chaotic. Rounding alone then separates the engine from its twin with the same mistake.
void MistakeFinder::add_chaos(const MistakeTable& table, const Engine& engine, std::vector<Sight>& moved) const {
  std::vector<MotionTask> tasks;
  std::vector<std::size_t> of;  // the tasks' views
  for (std::size_t v = 0; v < table.views.size(); ++v) {
    const View& view = table.views[v];
    if (view.kind != View::Kind::twin || !moved[v].why.empty()) continue;
    for (MotionTask& task : nudged_tasks(tasks_of(view, probes_[view.probe], engine, run_.settings, nullptr)))
      tasks.push_back(std::move(task)), of.push_back(v);
  }
  const std::vector<StateSeries> motions = motions_of(tasks, options_.limit);
  for (std::size_t n = 0; n < of.size(); ++n) moved[of[n]].coarse = motions[n].states;
}

std::vector<Hypothesis> MistakeFinder::simulated(const MistakeTable& table, std::vector<Hypothesis> hypotheses,
                                                 bool only_smooth) const {
  const auto is_asked = [&](const View& view, const Sight& sight) {
    const bool is_of_contacts = view.can_touch && view.kind == View::Kind::accurate;
    return sight.source == Sight::Source::none && !(only_smooth && is_of_contacts);
  };
  std::vector<MotionTask> tasks;
  for (Hypothesis& hypothesis : hypotheses) {
    hypothesis.sights.resize(table.views.size());
    for (std::size_t v = 0; v < table.views.size(); ++v) {
      const View& view = table.views[v];
      if (!is_asked(view, hypothesis.sights[v])) continue;
      for (MotionTask& task :
           tasks_of(view, probes_[view.probe], engines_.find(view.base.engine), view.base.settings, hypothesis.fault))
        tasks.push_back(std::move(task));
    }
  }
  const std::vector<StateSeries> motions = motions_of(tasks, kMostOfMistake);
  const EngineInfo& engine = engines_.info_of(run_.engine);
  std::size_t at = 0;
  for (Hypothesis& hypothesis : hypotheses) {
    for (std::size_t v = 0; v < table.views.size(); ++v) {
      const View& view = table.views[v];
      Sight& sight = hypothesis.sights[v];
      if (is_asked(view, sight)) sight = seen(view, motions, at), at += view.dt.size();
      sight.as_loaded_alone = is_fed_back(*hypothesis.fault, *probes_[view.probe].scene, engine);
    }
  }
  return hypotheses;
}

const MistakeTable& MistakeFinder::table_for(const RunName* of_points) {
  const std::string key = of_points ? of_points->text : "";
  if (const auto found = tables_.find(key); found != tables_.end()) return found->second;
  MistakeTable table;
  table.views = views_of(engines_, run_, probes_, of_points);
  table.bases = sights(table, nullptr, nullptr);
  table.observations = observations_of(table.views, table.bases, probes_);
  table.hypotheses = simulated(table, known_mistakes());
  table.find_idle();
  return tables_.emplace(key, std::move(table)).first->second;  // whole, or not at all
}

// The method of the core that steps points as the engine does. The median decides, because few probes show a mistake.
RunName MistakeFinder::nearest_method(const Engine& engine) {
  RunName best;
  double least = std::numeric_limits<double>::infinity();
  for (const char* name : {"core:semi-implicit-euler,orientation=quaternion-exponential",
                           "core:semi-implicit-euler,orientation=quaternion-additive", "core:explicit-euler",
                           "core:velocity-verlet", "core:implicit-midpoint"}) {
    MistakeTable one;
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

namespace {

// A mistake of some amount, and how well its motion has the shape of the engine's error.
struct Candidate {
  std::size_t row;  // of the table
  Trace::Fit fit;
  Hypothesis hypothesis;
};

// The sign says nothing: too little is too much by a negative amount.
double likeness(const Trace::Fit& fit) { return std::abs(fit.cosine); }

// The best one of each row, and of these the best few.
std::vector<Candidate> best_few(std::vector<Candidate> candidates, std::size_t most) {
  std::stable_sort(candidates.begin(), candidates.end(),
                   [](const Candidate& a, const Candidate& b) { return likeness(a.fit) > likeness(b.fit); });
  std::set<std::size_t> rows;
  std::erase_if(candidates, [&](const Candidate& candidate) { return !rows.insert(candidate.row).second; });
  if (candidates.size() > most) candidates.erase(candidates.begin() + static_cast<long>(most), candidates.end());
  return candidates;
}

// The next amount for the fixed point `fitted`(amount) = amount, by the secant through the last two.
double next_amount(double amount, double fitted, double amount_before, double fitted_before) {
  const double slope = (fitted - fitted_before) / (amount - amount_before);
  const bool is_useful = std::isfinite(slope) && std::abs(slope) < 0.9;
  return is_useful ? amount + (fitted - amount) / (1 - slope) : fitted;
}

}  // namespace

// A large amount moves bodies along another path than a small one. Mistakes whose motion has something of the error's
// shape are tried at up to a thousand times their amount.
std::vector<Hypothesis> MistakeFinder::larger_amounts(const Trace& trace, const MistakeTable& table) const {
  constexpr double kSomething = 0.1;
  constexpr std::size_t kMost = 6;
  std::vector<Candidate> found;
  for (std::size_t row = 0; row < table.hypotheses.size(); ++row) {
    const Hypothesis& hypothesis = table.hypotheses[row];
    if (!hypothesis.fault->by) continue;
    const Trace::Fit fit = trace.fit(hypothesis);
    if (likeness(fit) > kSomething) found.push_back({row, fit, hypothesis});
  }
  std::vector<Hypothesis> larger;
  for (const Candidate& candidate : best_few(std::move(found), kMost)) {
    const Fault& fault = *candidate.hypothesis.fault;
    std::vector<Hypothesis> amounts;
    for (const double times : {10.0, 100.0, kMostTimes, -100.0}) {
      const auto made = std::make_shared<Fault>(fault.by(times * fault.amount));
      amounts.push_back({made, {made->name}, {}});
    }
    for (Hypothesis& one : simulated(table, std::move(amounts), candidate.fit.is_smooth))
      larger.push_back(std::move(one));
  }
  return larger;
}

// Mistakes whose motion has the shape of the error are scaled until they fit it.
void MistakeFinder::add_amounts(const Trace& trace, const MistakeTable& table,
                                std::vector<Hypothesis>& hypotheses) const {
  constexpr double kSameShape = 0.7;  // further rounds find the amount of a nonlinear mistake
  constexpr double kSameAmount = 1e-4;
  constexpr std::size_t kMost = 3;
  constexpr int kRounds = 8;
  std::vector<Hypothesis> tried = table.hypotheses;
  for (Hypothesis& larger : larger_amounts(trace, table)) tried.push_back(std::move(larger));
  std::vector<Candidate> found;
  for (std::size_t n = 0; n < tried.size(); ++n) {
    if (!tried[n].fault->by) continue;
    const Trace::Fit fit = trace.fit(tried[n]);
    // The amounts of one row are one row: they differ by their number alone.
    const auto row = std::find_if(tried.begin(), tried.end(), [&](const Hypothesis& other) {
      return other.fault->by && other.fault->by(1).name == tried[n].fault->by(1).name;
    });
    if (likeness(fit) > kSameShape) found.push_back({static_cast<std::size_t>(row - tried.begin()), fit, tried[n]});
  }
  for (Candidate& candidate : best_few(std::move(found), kMost)) {
    Hypothesis at = std::move(candidate.hypothesis);
    const double most = kMostTimes * std::abs(tried[candidate.row].fault->amount);
    double before = 0, fitted_before = 0;
    for (int round = 0; round < kRounds; ++round) {
      const double amount = at.fault->amount, fitted = trace.fit(at).factor * amount;
      const double next = round == 0 ? fitted : next_amount(amount, fitted, before, fitted_before);
      if (std::abs(next) > most) break;
      if (next == 0 || !std::isfinite(next) || std::abs(next - amount) <= kSameAmount * std::abs(amount)) break;
      before = amount, fitted_before = fitted;
      const auto fault = std::make_shared<Fault>(at.fault->by(next));
      at = simulated(table, {{fault, {fault->name}, {}}}, candidate.fit.is_smooth).front();
    }
    const auto is_same = [&](const Hypothesis& other) { return other.names == at.names; };
    if (std::none_of(hypotheses.begin(), hypotheses.end(), is_same))
      hypotheses.push_back(simulated(table, {std::move(at)}).front());
  }
}

// Two mistakes in one engine.
void MistakeFinder::add_pairs(const Trace& trace, const MistakeTable& table,
                              std::vector<Hypothesis>& hypotheses) const {
  std::vector<Hypothesis> tried;
  for (const auto& [i, j] : trace.likely_pairs(table.hypotheses, probes_)) tried.push_back(table.pair(i, j));
  for (Hypothesis& hypothesis : simulated(table, std::move(tried))) hypotheses.push_back(std::move(hypothesis));
}

// A mistake without effect alone may have one beside another. So the suspects that a report shows are simulated whole.
std::vector<Suspect> MistakeFinder::ranked(const Trace& trace, const MistakeTable& table,
                                           std::vector<Hypothesis>& hypotheses) const {
  while (true) {
    std::vector<Suspect> suspects = trace.ranked(hypotheses, probes_);
    std::vector<std::size_t> unsure;
    for (std::size_t n = 0; n < std::min(kShown, suspects.size()); ++n) {
      const auto is_borrowed = [](const Sight& sight) { return sight.source == Sight::Source::borrowed; };
      if (std::ranges::any_of(hypotheses[suspects[n].hypothesis].sights, is_borrowed))
        unsure.push_back(suspects[n].hypothesis);
    }
    if (unsure.empty()) return suspects;
    std::vector<Hypothesis> whole;
    for (const std::size_t h : unsure) whole.push_back({hypotheses[h].fault, hypotheses[h].names, {}});
    whole = simulated(table, std::move(whole));
    for (std::size_t n = 0; n < unsure.size(); ++n) hypotheses[unsure[n]] = std::move(whole[n]);
  }
}

// The places where the engine was seen, those where not, and beside what.
void MistakeFinder::note_sights(const MistakeTable& table, const std::vector<Sight>& moved,
                                MistakeReport& report) const {
  for (std::size_t v = 0; v < moved.size(); ++v) {
    const std::string& id = probes_[table.views[v].probe].id;
    if (!moved[v].why.empty()) {
      report.failures.push_back(fmt::format("{}: {}", id, moved[v].why));
    } else if (report.seen.empty() || report.seen.back() != id) {
      report.seen.push_back(id);
      if (table.views[v].kind == View::Kind::twin) report.by_twin.push_back(id);
    }
  }
  std::set<std::string> beside;
  for (const View& view : table.views) beside.insert(view.base.text);
  for (const std::string& name : beside) report.beside += (report.beside.empty() ? "" : ", ") + name;
}

// The laws of each probe where the engine was seen, at the probe's step and at half of it.
std::vector<LawDrift> MistakeFinder::law_drifts(const Engine& engine, const std::vector<std::string>& seen) const {
  std::vector<MotionTask> tasks;
  std::vector<const ProbeScene*> probes;
  for (const ProbeScene& probe : probes_) {
    if (std::find(seen.begin(), seen.end(), probe.id) == seen.end() || laws_of(*probe.scene).empty()) continue;
    probes.push_back(&probe);
    const long steps = std::max(1L, std::lround(probe.duration / probe.dt));
    for (const long times : {1L, 2L}) {
      tasks.push_back(
          {&engine, run_.settings, probe.scene, nullptr, probe.dt / static_cast<double>(times), steps * times, times});
    }
  }
  const std::vector<StateSeries> motions = motions_of(tasks, options_.limit);
  LawWatch watch(engines_.info_of(run_.engine).precision == "single");
  for (std::size_t n = 0; n < probes.size(); ++n) watch.add(*probes[n], motions[2 * n], motions[2 * n + 1]);
  return watch.drifts();
}

MistakeReport MistakeFinder::report(const Engine& engine) {
  const bool is_single = engines_.info_of(run_.engine).precision == "single";
  const RunName* of_points = nullptr;
  RunName method;
  if (needs_same_method(views_of(engines_, run_, probes_, nullptr))) {
    method = nearest_method(engine);
    if (!method.text.empty()) of_points = &method;
  }
  const MistakeTable& table = table_for(of_points);
  MistakeReport report;
  report.known = faults().size();
  std::vector<Sight> moved = sights(table, &engine, nullptr);
  add_chaos(table, engine, moved);
  note_sights(table, moved, report);
  if (report.seen.empty()) return report.verdict = MistakeReport::Verdict::untried, report;
  report.laws = law_drifts(engine, report.seen);
  for (LawDrift& law : report.laws)
    law.has_twin = std::find(report.by_twin.begin(), report.by_twin.end(), law.id) != report.by_twin.end();
  const Trace trace(table.views, table.observations, std::move(moved), is_single);
  std::vector<Hypothesis> hypotheses = table.hypotheses;
  const auto best = [&] {
    const auto found = trace.ranked(hypotheses, probes_);
    return found.empty() ? 0.0 : found.front().explains;
  };
  if (trace.probes_off(hypotheses).empty()) return report;
  if (best() < kSure) add_amounts(trace, table, hypotheses);
  if (best() < kSure) add_pairs(trace, table, hypotheses);
  const std::vector<Suspect> suspects = ranked(trace, table, hypotheses);
  for (const std::size_t probe : trace.probes_off(hypotheses)) report.off.push_back(probes_[probe].id);
  for (const Suspect& suspect : suspects) {
    if (report.suspects.size() == kShown || suspect.explains < kNotable) break;
    report.suspects.push_back(
        {hypotheses[suspect.hypothesis].names, suspect.explains, suspect.explained, suspect.cases});
  }
  report.verdict = MistakeReport::Verdict::unnamed;
  if (suspects.empty() || suspects.front().explains < kNamed) return report;
  const double rest = 1 - suspects.front().explains;
  for (const auto& suspect : report.suspects) report.leaders += 1 - suspect.explains <= rest + kAlike * (rest + 1e-6);
  report.verdict = report.leaders > 1 ? MistakeReport::Verdict::alike : MistakeReport::Verdict::named;
  return report;
}

}  // namespace rigor::inline analysis
