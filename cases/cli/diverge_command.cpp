// rigor diverge: says when, where and why two runs part, which is right, and which setting closes the gap.
#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "cases/analysis/divergence/divergence.h"
#include "cases/case/selection.h"
#include "cases/cli/grid_run.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/plan_sentence.h"
#include "cases/cli/progress/progress.h"
#include "cases/report/html/data_element.h"
#include "cases/report/json/pairs/divergence_json.h"
#include "cases/report/wording/divergence.h"
#include "cases/report/wording/printed_command.h"
#include "core/base/error.h"
#include "core/base/json.h"

namespace rigor::inline cli {
namespace {

class DivergeCommand : public Command {
 public:
  void declare(Options& options) override {
    cases_.declare(options), engines_.declare(options), steps_.declare(options), duration_.declare(options);
    jobs_.declare(options), json_.declare(options), timeout_.declare(options);
    options.add({"--within", "BOUND",
                 "a bound: 1mm, position=1cm, 1mrad, velocity=2cm/s; default: 1 mm for each metre of the scene, and "
                 "1 mrad"},
                within_);
    options.add({"--out", "DIR", "also write the reports of both runs to DIR; report.html shows where they part"},
                [this](const std::string& text) { out_ = text; });
  }

  int run(const Invocation& invocation) override {
    const EngineTable engines = engines_.outside.table(timeout_.seconds);
    Case definition = the_case(cases_, invocation, engines);
    const std::vector<DivergingRun> runs = runs_of(definition, engines);
    std::vector<StepSize> steps = {runs[0].dt};
    if (!(runs[1].dt == runs[0].dt)) steps.push_back(runs[1].dt);
    override_run(definition, {steps, duration_.seconds});
    const PartingBounds bounds =
        within_.empty() ? default_parting_bounds(definition.scene) : parse_parting_bounds(within_);
    if (!out_) {
      say_what_was_found(diverged(engines, definition, runs, bounds));
      return kGood;
    }
    const GridRequest asked = grid_of(invocation, definition);
    OutputFolder folder = output_folder_of(asked);  // before any work
    const Divergence found = diverged(engines, definition, runs, bounds);
    say_what_was_found(found);
    return write_page(found, asked, definition, engines, folder);
  }

 private:
  std::string json_text(const Divergence& found) const {
    return json_of(found).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
  }

  Json json_of(const Divergence& found) const {
    return divergence_json(found, command_of_winner(found), calls_of(found));
  }

  void say_what_was_found(const Divergence& found) const {
    if (json_.is_on) return print(json_text(found));
    print_table(text_of(found, command_of_winner(found), calls_of(found)));
  }

  // Both runs as a grid of this case.
  GridRequest grid_of(const Invocation& invocation, const Case& definition) const {
    GridRequest asked;
    asked.invocation = invocation, asked.cases = cases_, asked.engines = engines_, asked.steps.dt = definition.dt;
    asked.duration = duration_, asked.jobs = jobs_, asked.timeout = timeout_, asked.out.dir = *out_;
    asked.deviations.dir = default_adapters_dir();
    return asked;
  }

  // Runs the grid and writes the reports of `rigor run`, with what was found.
  int write_page(const Divergence& found, const GridRequest& asked, const Case& definition, const EngineTable& engines,
                 OutputFolder& folder) const {
    std::vector<RunName> names = {found.a.name};
    if (!is_same_run(found.a.name, found.b.name)) names.push_back(found.b.name);
    GridRun run = plan_runs_of(definition, names, asked, engines);
    say(plan_sentence(run.grid, asked));
    GridOptions options = options_of(run, folder);
    options.stable_steps = false;
    run_with_progress(run.grid, engines, options, asked);
    judge(run);
    ReportAdditions added;
    added.files = {{kDivergenceFile, json_text(found)}};
    added.on_page = [&](const std::string& page) {
      return with_data_element(page, kDivergenceElement, json_of(found));
    };
    added.can_resume = false;
    const bool is_whole = write_reports(run.grid, folder, added);
    return ending_of(run.grid, is_whole);
  }

  // One engine at two steps, or two engines at one step or at one each.
  std::vector<DivergingRun> runs_of(const Case& definition, const EngineTable& engines) const {
    const std::vector<std::string>& names = engines_.engines;
    const std::vector<StepSize> steps = steps_.dt.empty() ? std::vector<StepSize>{definition.dt.front()} : steps_.dt;
    if (names.empty() || names.size() > 2)
      throw InputError("rigor diverge: takes two --engine, or one --engine with two --dt; see rigor list engines");
    if (steps.size() > 2) throw InputError("rigor diverge: takes at most two --dt, the first for the first run");
    std::vector<DivergingRun> runs;
    for (const std::size_t n : {0, 1})
      runs.push_back(
          {run_of_option(names[std::min(n, names.size() - 1)], engines.infos()), steps[std::min(n, steps.size() - 1)]});
    if (runs[0].name.text == runs[1].name.text && runs[0].dt == runs[1].dt)
      throw InputError(fmt::format("rigor diverge: both runs are {} at {} s; rigor repeat compares a run with itself",
                                   runs[0].name.text, runs[0].dt.text));
    return runs;
  }

  Divergence diverged(const EngineTable& engines, const Case& definition, const std::vector<DivergingRun>& runs,
                      const PartingBounds& bounds) const {
    Progress progress("motions");
    std::size_t motions = 0;
    DivergenceOptions options{jobs_.count, timeout_.seconds, [&] { progress.show(++motions, 0); }};
    return diverge(engines, definition, runs[0], runs[1], bounds, options);
  }

  // The run that the swap changes; null if it changes the step alone, or nothing.
  static const DivergingRun* winner_of(const Divergence& found) {
    if (!found.swaps.best) return nullptr;
    const TriedSwap& best = *found.swaps.best;
    const bool is_of_a = best.swaps.front().side == RunPair::Side::a;
    return is_of_a ? &best.a : &best.b;
  }

  static std::vector<std::string> calls_of(const Divergence& found) {
    const DivergingRun* winner = winner_of(found);
    return winner ? engine_calls(winner->name, fmt::format("{:.17g}", winner->dt.seconds)) : std::vector<std::string>();
  }

  std::string command_of_winner(const Divergence& found) const {
    if (!winner_of(found)) return "";
    const DivergingRun& winner = *winner_of(found);
    std::vector<std::string> words = {"rigor", "run"};
    words.insert(words.end(), cases_.words.begin(), cases_.words.end());
    words.insert(words.end(), {"--engine", winner.name.text, "--dt", winner.dt.text});
    const std::vector<std::string> from = where_from(winner.name.text);
    words.insert(words.end(), from.begin(), from.end());
    return pasted(words);
  }

  CaseWords cases_;
  EngineOptions engines_;
  StepOption steps_;
  DurationOption duration_;
  JobsOption jobs_;
  JsonOption json_;
  TimeoutOption timeout_;
  std::vector<std::string> within_;
  std::optional<std::string> out_;
};

}  // namespace

CommandRow diverge_row() {
  return {"diverge",
          "say when, where and why two runs part, and which setting closes the gap",
          "CASE",
          "a case or a file",
          {{"rigor diverge joints/pendulum-90 --engine ode --engine bullet --dt 1/240", "two engines"},
           {"rigor diverge tops/dzhanibekov-box --engine ode --engine ode,gyroscopic=off --dt 1/60", "two settings"},
           {"rigor diverge joints/pendulum-90 --engine ode --engine bullet --dt 1/240 --out parted",
            "a page, parted/report.html, with both motions over each other"},
           {"rigor diverge robot.urdf --engine mujoco --dt 1/500 --dt 1/1000 --within position=1cm", "two steps"}},
          make_command<DivergeCommand>};
}

}  // namespace rigor::inline cli
