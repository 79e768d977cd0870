// rigor tune: finds the cheapest setting of an engine that keeps bounds. Prints the run and the engine's own calls to
// paste, and compares the other engines.
#include <fmt/format.h>

#include <algorithm>

#include "adapters/engines.h"
#include "cases/analysis/tuning/tuning.h"
#include "cases/cli/chosen_cases.h"
#include "cases/cli/commands.h"
#include "cases/cli/options.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/progress.h"
#include "cases/cli/vocabulary.h"
#include "cases/report/wording/printed_command.h"
#include "cases/runner/grid.h"
#include "core/base/error.h"

namespace rigor {
namespace {

constexpr std::size_t kSettings = 48, kSettingsBeside = 16;  // tried of the engine itself; of each of the others

std::vector<Case> cases_of(const CommandLine& line, const EngineTable& engines) {
  if (line.words.empty()) throw InputError("rigor tune: takes at least one case; see rigor list cases");
  if (line.engines.size() != 1) throw InputError("rigor tune: takes exactly one --engine; see rigor list engines");
  if (line.within.empty())
    throw InputError("rigor tune: takes at least one --within BOUND, as 1mm, 1mrad, '2% energy' or METRIC=VALUE");
  std::vector<Case> cases = chosen_cases(line, vocabulary_of(engines.infos()));
  for (Case& definition : cases) override_run(definition, {{}, line.duration});
  return cases;
}

std::vector<Bound> bounds_of(const CommandLine& line) {
  std::vector<Bound> bounds;
  for (const std::string& text : line.within) {
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
  if (!tuning.without_effect.empty())
    text += fmt::format("  without effect here: {}\n", fmt::join(tuning.without_effect, ", "));
  return text + "\n";
}

// The winner's run, to paste.
std::string run_of_winner(const CommandLine& line, const TunedPoint& best) {
  std::vector<std::string> words = {"rigor", "run"};
  words.insert(words.end(), line.words.begin(), line.words.end());
  words.insert(words.end(), {"--engine", best.run.text, "--dt", best.dt.text});
  if (line.duration) words.insert(words.end(), {"--duration", fmt::format("{}", *line.duration)});
  const std::vector<std::string> from = where_from(best.run.text);
  words.insert(words.end(), from.begin(), from.end());
  return pasted(words);
}

// The same tuning of another engine, to paste.
std::string tuning_of(const CommandLine& line, const std::string& engine) {
  std::vector<std::string> words = {"rigor", "tune"};
  words.insert(words.end(), line.words.begin(), line.words.end());
  words.insert(words.end(), {"--engine", engine});
  for (const std::string& bound : line.within) words.insert(words.end(), {"--within", bound});
  if (line.duration) words.insert(words.end(), {"--duration", fmt::format("{}", *line.duration)});
  const std::vector<std::string> from = where_from(engine);
  words.insert(words.end(), from.begin(), from.end());
  return pasted(words);
}

std::string winner_text(const CommandLine& line, const Tuning& tuning, const EngineTable& engines) {
  const TunedPoint& best = *tuning.winner;
  std::string text = fmt::format(
      "winner: {} at {} s, {} ms of CPU a simulated second ({} to {} in 5 repeats), {:.3g} of the bound\n  {}\n",
      best.run.text, best.dt.text, milliseconds(best.cost), milliseconds(best.least), milliseconds(best.most),
      best.error, run_of_winner(line, best));
  const auto calls =
      engine_calls(parse_run_name(best.run.text, engines.infos()), fmt::format("{}.0 / {}", 1, best.dt.text.substr(2)));
  if (!calls.empty())
    text += fmt::format("  the same in the engine's own calls:\n    {}\n", fmt::join(calls, "\n    "));
  if (!tuning.ties.empty()) {
    text += "  repeats cannot tell these from the winner:\n";
    for (const TunedPoint& tie : tuning.ties) text += "  " + row(tie);
  }
  return text + "\n";
}

std::string beside_text(const CommandLine& line, const std::vector<Tuning>& others) {
  std::string text = fmt::format("the other engines, with at most {} settings each\n  {:>10} {:>12}  {:<9} {}\n",
                                 kSettingsBeside, "error", "cost [ms/s]", "dt [s]", "run");
  for (const Tuning& other : others) {
    text += other.winner ? row(*other.winner)
                         : fmt::format("  {:>10} {:>12}  {:<9} {}: {}\n", "-", "-", "-", other.engine,
                                       other.nearest.empty() ? "nothing ran" : other.nearest);
  }
  if (!others.empty())
    text += fmt::format("up to {} settings of one of them: {}\n", kSettings, tuning_of(line, others.front().engine));
  return text;
}

// Reports how many runs are finished, under the engine's name.
Tuning tuned(const std::string& engine, const std::vector<Case>& cases, const std::vector<Bound>& bounds,
             const EngineTable& engines, TuneOptions options) {
  Progress progress("runs of " + engine);
  options.on_runs = [&](std::size_t runs) { progress.show(runs, 0); };
  return tune(engine, cases, bounds, engines, options);
}

}  // namespace

int tune_command(const CommandLine& line, const EngineTable& engines) {
  const std::vector<Case> cases = cases_of(line, engines);
  const std::vector<Bound> bounds = bounds_of(line);
  const std::string asked_for = parse_run_name(line.engines.front(), engines.infos()).engine;
  TuneOptions options{line.jobs, line.limit, line.seed, kSettings};
  const Tuning tuning = tuned(line.engines.front(), cases, bounds, engines, options);
  std::string held;
  for (const Bound& bound : bounds)
    held += fmt::format("{}{} (|{}| up to {:g})", held.empty() ? "" : ", ", bound.text, bound.metric, bound.most);
  std::string text =
      fmt::format("within {} on {}\nerror: the largest share of a bound; cost: CPU time per simulated second\n\n", held,
                  fmt::join(line.words, ", "));
  if (!tuning.front.empty()) text += front_text(tuning);
  text += tuning.winner ? winner_text(line, tuning, engines)
                        : fmt::format("no setting of {} keeps {}{}{}\n\n", tuning.engine, held,
                                      tuning.nearest.empty() ? "" : "; ", tuning.nearest);
  for (const std::string& remark : tuning.remarks) text += remark + "\n";
  print_table(text);
  options.settings = kSettingsBeside;
  std::vector<Tuning> others;
  for (const EngineInfo& engine : engines.infos()) {
    if (engine.name != asked_for && !is_on_request(engine.name))
      others.push_back(tuned(engine.name, cases, bounds, engines, options));
  }
  print_table(beside_text(line, others));
  return tuning.winner ? kGood : kGateFailed;
}

CommandRow tune_row() {
  return {"tune",
          "find the cheapest setting of an engine within bounds; exit 1 if there is none",
          "CASE",
          kCases,
          with_import_options(
              {"--duration", "--engine", "--jobs", "--plugin", "--seed", "--suite", "--timeout", "--within"}),
          {{"rigor tune springs/fixed-spring --engine ode --within 1mm", "position within a millimetre"},
           {"rigor tune springs --engine bullet --within 1cm --within '2% energy'", "two bounds on a family"}},
          tune_command};
}

}  // namespace rigor
