// rigor tune: finds the cheapest setting of an engine that keeps bounds. Prints the run and the engine's own calls to
// paste, and compares the other engines.
#include <fmt/format.h>

#include <algorithm>

#include "adapters/engines.h"
#include "cases/analysis/tuning/tuning.h"
#include "cases/cli/chosen_cases.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/progress.h"
#include "cases/cli/vocabulary.h"
#include "cases/metrics/metric.h"
#include "cases/report/wording/printed_command.h"
#include "cases/report/wording/wording.h"
#include "cases/runner/grid.h"
#include "core/base/error.h"

namespace rigor::inline cli {
namespace {

constexpr std::size_t kSettings = 48, kSettingsBeside = 16;  // tried of the engine itself; of each of the others

struct TuneRequest {
  Invocation invocation;
  CaseWords cases;
  EngineOptions engines;
  DurationOption duration;
  JobsOption jobs;
  SeedOption seed;
  TimeoutOption timeout;
  std::vector<std::string> within;  // bounds, "1mm"

  void declare(Options& options) {
    cases.declare(options), engines.declare(options), duration.declare(options), jobs.declare(options);
    seed.declare(options), timeout.declare(options);
    options.add({"--within", "BOUND", "a bound: 1mm (position), 1mrad (orientation), 2% energy, or METRIC=VALUE"},
                within);
  }
};

std::vector<Case> cases_of(const TuneRequest& asked, const EngineTable& engines) {
  if (asked.cases.words.empty()) throw InputError("rigor tune: takes at least one case; see rigor list cases");
  if (asked.engines.engines.size() != 1)
    throw InputError("rigor tune: takes exactly one --engine; see rigor list engines");
  if (asked.within.empty())
    throw InputError("rigor tune: takes at least one --within BOUND, as 1mm, 1mrad, '2% energy' or METRIC=VALUE");
  std::vector<Case> cases = chosen_cases(asked.cases, asked.invocation, vocabulary_of(engines.infos()));
  for (Case& definition : cases) override_run(definition, {{}, asked.duration.seconds});
  return cases;
}

std::vector<Bound> bounds_of(const TuneRequest& asked) {
  std::vector<Bound> bounds;
  for (const std::string& text : asked.within) {
    bounds.push_back(parse_bound(text));
    for (std::size_t i = 0; i + 1 < bounds.size(); ++i) {
      if (bounds[i].metric == bounds.back().metric)
        throw InputError(fmt::format("--within: '{}' and '{}' both bound {}; give one of them", bounds[i].text, text,
                                     bounds[i].metric));
    }
  }
  return bounds;
}

std::string milliseconds(double cost) { return fmt::format("{:.3g}", 1e3 * cost); }

std::string row(const TunedPoint& point) {
  return fmt::format("  {:>10} {:>12}  {:<9} {}\n", fmt::format("{:.3g}", point.error), milliseconds(point.cost),
                     point.dt.text, point.run.text);
}

std::string front_text(const Tuning& tuning) {
  std::string text = fmt::format("{}: error against cost, from {} settings in {} runs\n  {:>10} {:>12}  {:<9} {}\n",
                                 tuning.engine, tuning.settings, tuning.runs, "error", "cost [ms/s]", "dt [s]", "run");
  for (const TunedPoint& point : tuning.front) text += row(point);
  if (tuning.is_refined) text += "  no tried value keeps the bound, so numbers between them were searched\n";
  if (!tuning.without_effect.empty())
    text += fmt::format("  without effect here: {}\n", fmt::join(tuning.without_effect, ", "));
  return text + "\n";
}

// The winner's run, to paste.
std::string run_of_winner(const TuneRequest& asked, const TunedPoint& best) {
  std::vector<std::string> words = {"rigor", "run"};
  words.insert(words.end(), asked.cases.words.begin(), asked.cases.words.end());
  words.insert(words.end(), {"--engine", best.run.text, "--dt", best.dt.text});
  if (asked.duration.seconds) words.insert(words.end(), {"--duration", fmt::format("{}", *asked.duration.seconds)});
  const std::vector<std::string> from = where_from(best.run.text);
  words.insert(words.end(), from.begin(), from.end());
  return pasted(words);
}

// The same tuning of another engine, to paste.
std::string tuning_of(const TuneRequest& asked, const std::string& engine) {
  std::vector<std::string> words = {"rigor", "tune"};
  words.insert(words.end(), asked.cases.words.begin(), asked.cases.words.end());
  words.insert(words.end(), {"--engine", engine});
  for (const std::string& bound : asked.within) words.insert(words.end(), {"--within", bound});
  if (asked.duration.seconds) words.insert(words.end(), {"--duration", fmt::format("{}", *asked.duration.seconds)});
  const std::vector<std::string> from = where_from(engine);
  words.insert(words.end(), from.begin(), from.end());
  return pasted(words);
}

// The options that the run leaves to their defaults.
std::string defaults_of(const RunName& run, const EngineTable& engines) {
  std::string text;
  for (const EngineInfo& engine : engines.infos()) {
    if (engine.name != run.engine) continue;
    for (const OptionInfo& option : method_of(engine, run.settings).options) {
      const auto value = default_value(option, run.settings.track);
      if (value && !run.settings.options.contains(option.name))
        text += fmt::format("{}{}={}", text.empty() ? "" : ", ", option.name, *value);
    }
  }
  return text;
}

constexpr const char* kToldOfWinner[] = {"position_error", "orientation_error", "penetration"};

// A setting may keep the bounds by a motion that nobody wants, as a contact so soft that a ball sinks in. This says
// what the bounds do not ask for, a line for each case.
std::string beyond_bounds(const TunedPoint& best, std::vector<Case> cases, const EngineTable& engines,
                          const TuneRequest& asked) {
  for (Case& definition : cases) definition.dt = {best.dt}, definition.gates.clear();
  const RunName run = parse_run_name(best.run.text, engines.infos());
  Results grid = plan_grid(cases, {run}, engines, {.stable_steps = false});
  GridOptions options;
  options.jobs = asked.jobs.count, options.limit = asked.timeout.seconds;
  options.stable_steps = options.is_thorough = options.spreads = false;
  run_grid(grid, engines, options, [](std::size_t, std::size_t) {});
  std::string text = "  beyond the bounds:\n";
  constexpr std::size_t kMost = 6;
  for (std::size_t i = 0; i < grid.cases.size(); ++i) {
    const CaseResult& result = grid.cases[i];
    if (i == kMost) return text + fmt::format("    and {} more; the line above runs them\n", grid.cases.size() - kMost);
    const Cell& cell = result.cells.front();
    text += fmt::format("    {}: {}", result.definition.id,
                        cell.status == Status::pass ? phrase_of(cell.stability) : cell.reason);
    for (const char* metric : kToldOfWinner) {
      const auto found = cell.metrics.find(metric);
      if (found != cell.metrics.end() && found->second.not_applicable.empty())
        text += fmt::format(", {} {}", metric, quantity_text(found->second.value, unit_of_metric(metric)));
    }
    text += "\n";
  }
  return text;
}

std::string winner_text(const TuneRequest& asked, const Tuning& tuning, const std::vector<Case>& cases,
                        const EngineTable& engines) {
  const TunedPoint& best = *tuning.winner;
  std::string text = fmt::format(
      "winner: {} at {} s, {} ms of CPU a simulated second ({} to {} in 5 repeats), {:.3g} of the bound\n  {}\n",
      best.run.text, best.dt.text, milliseconds(best.cost), milliseconds(best.least), milliseconds(best.most),
      best.error, run_of_winner(asked, best));
  const RunName run = parse_run_name(best.run.text, engines.infos());
  text += beyond_bounds(best, cases, engines, asked);
  const std::string defaults = defaults_of(run, engines);
  if (!defaults.empty()) text += fmt::format("  by default: {}\n", defaults);
  const auto calls = engine_calls(run, fmt::format("{}.0 / {}", 1, best.dt.text.substr(2)));
  if (!calls.empty())
    text += fmt::format("  the same in the engine's own calls:\n    {}\n", fmt::join(calls, "\n    "));
  if (!tuning.ties.empty()) {
    text += "  repeats cannot tell these from the winner:\n";
    for (const TunedPoint& tie : tuning.ties) text += "  " + row(tie);
  }
  return text + "\n";
}

std::string beside_text(const TuneRequest& asked, const std::vector<Tuning>& others) {
  std::string text = fmt::format("the other engines, with at most {} settings each\n  {:>10} {:>12}  {:<9} {}\n",
                                 kSettingsBeside, "error", "cost [ms/s]", "dt [s]", "run");
  for (const Tuning& other : others) {
    text += other.winner ? row(*other.winner)
                         : fmt::format("  {:>10} {:>12}  {:<9} {}: {}\n", "-", "-", "-", other.engine,
                                       other.nearest.empty() ? "nothing ran" : other.nearest);
  }
  if (!others.empty())
    text += fmt::format("up to {} settings of one of them: {}\n", kSettings, tuning_of(asked, others.front().engine));
  return text;
}

// Reports how many runs are finished, under the engine's name.
Tuning tuned(const std::string& engine, const std::vector<Case>& cases, const std::vector<Bound>& bounds,
             const EngineTable& engines, TuneOptions options) {
  Progress progress("runs of " + engine);
  options.on_runs = [&](std::size_t runs) { progress.show(runs, 0); };
  return tune(engine, cases, bounds, engines, options);
}

int answer_of_tuning(const TuneRequest& asked, const EngineTable& engines) {
  const std::vector<Case> cases = cases_of(asked, engines);
  const std::vector<Bound> bounds = bounds_of(asked);
  const std::string asked_for = parse_run_name(asked.engines.engines.front(), engines.infos()).engine;
  TuneOptions options{asked.jobs.count, asked.timeout.seconds, asked.seed.seed, kSettings};
  const Tuning tuning = tuned(asked.engines.engines.front(), cases, bounds, engines, options);
  std::string held;
  for (const Bound& bound : bounds)
    held += fmt::format("{}{} (|{}| up to {:g})", held.empty() ? "" : ", ", bound.text, bound.metric, bound.most);
  std::string text =
      fmt::format("within {} on {}\nerror: the largest share of a bound; cost: CPU time per simulated second\n\n", held,
                  fmt::join(asked.cases.words, ", "));
  if (!tuning.front.empty()) text += front_text(tuning);
  text += tuning.winner ? winner_text(asked, tuning, cases, engines)
                        : fmt::format("no setting of {} keeps {}{}{}\n\n", tuning.engine, held,
                                      tuning.nearest.empty() ? "" : "; ", tuning.nearest);
  for (const std::string& remark : tuning.remarks) text += remark + "\n";
  print_table(text);
  options.settings = kSettingsBeside, options.refines = false;
  std::vector<Tuning> others;
  for (const EngineInfo& engine : engines.infos()) {
    if (engine.name != asked_for && !is_on_request(engine.name))
      others.push_back(tuned(engine.name, cases, bounds, engines, options));
  }
  print_table(beside_text(asked, others));
  return tuning.winner ? kGood : kGateFailed;
}

class TuneCommand : public Command {
 public:
  void declare(Options& options) override { asked_.declare(options); }

  int run(const Invocation& invocation) override {
    asked_.invocation = invocation;
    return answer_of_tuning(asked_, asked_.engines.outside.table(asked_.timeout.seconds));
  }

 private:
  TuneRequest asked_;
};

}  // namespace

CommandRow tune_row() {
  return {"tune",
          "find the cheapest setting of an engine within bounds; exit 1 if there is none",
          "CASE",
          kCases,
          {{"rigor tune springs/fixed-spring --engine ode --within 1mm", "position within a millimetre"},
           {"rigor tune springs --engine bullet --within 1cm --within '2% energy'", "two bounds on a family"}},
          make_command<TuneCommand>};
}

}  // namespace rigor::inline cli
