// rigor fit: finds the values of keys at which an engine follows the truth best, and says how sure they are.
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "cases/analysis/fitting/fitting.h"
#include "cases/case/case_reader.h"
#include "cases/case/recording/recording_reader.h"
#include "cases/cli/chosen_cases.h"
#include "cases/cli/commands.h"
#include "cases/cli/grid_run.h"
#include "cases/cli/output.h"
#include "cases/cli/progress/progress.h"
#include "cases/cli/vocabulary.h"
#include "cases/report/json/fit_json.h"
#include "cases/report/wording/printed_command.h"
#include "cases/report/wording/wording.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/scene/toml/scene_reader.h"
#include "core/scene/toml/writing/value_writer.h"

namespace rigor::inline cli {
namespace {

struct FitRequest {
  Invocation invocation;
  CaseWords cases;
  EngineOptions engines;
  StepOption steps;
  DurationOption duration;
  JobsOption jobs;
  JsonOption json;
  SeedOption seed;
  TimeoutOption timeout;
  std::vector<std::string> vary;  // KEY=LO..HI
  double hold_out = 0;
  std::string out;  // the fitted case file; empty: none

  void declare(Options& options) {
    cases.declare(options), engines.declare(options), steps.declare(options), duration.declare(options);
    jobs.declare(options), json.declare(options), seed.declare(options), timeout.declare(options);
    options.add({"--vary", "KEY=LO..HI",
                 "a value to fit within a range: dt, a method's option or a path below scene; LO..HI:log searches in "
                 "logarithms"},
                vary);
    options.add({"--hold-out", "F", "a share of the trials, from 0 to 1, that takes no part and is predicted"},
                [this](const std::string& text) { hold_out = share_of(text); });
    options.add({"--out", "FILE", "write the case file with the fitted values"}, out);
  }

  static double share_of(const std::string& text) {
    double share = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), share);
    if (error != std::errc() || end != text.data() + text.size() || !(share > 0 && share < 1))
      throw InputError(fmt::format("--hold-out: found '{}'; allowed: a number between 0 and 1, as 0.5", text));
    return share;
  }
};

std::vector<Case> cases_of(const FitRequest& asked, const Vocabulary& words) {
  if (asked.cases.words.empty()) throw InputError("rigor fit: takes at least one case; see rigor list cases");
  if (asked.engines.engines.empty()) throw InputError("rigor fit: takes at least one --engine; see rigor list engines");
  if (asked.vary.empty())
    throw InputError("rigor fit: takes at least one --vary KEY=LO..HI, as scene.contact_default.friction=0.05..0.5");
  if (asked.steps.dt.size() > 1) throw InputError("rigor fit: takes at most one --dt");
  std::vector<Case> cases =
      overridden_cases(asked.cases, asked.invocation, {asked.steps.dt, asked.duration.seconds}, words);
  if (!asked.out.empty() && (cases.size() > 1 || asked.engines.engines.size() > 1))
    throw InputError("--out: writes one case file, and this is about several cases or engines; give one of each");
  for (Case& definition : cases) {  // at its coarsest step
    const auto coarsest = std::max_element(definition.dt.begin(), definition.dt.end(),
                                           [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
    definition.dt = {*coarsest};
  }
  return cases;
}

std::string number(double value) { return fmt::format("{:.4g}", value); }

// The data tell one end alone if the other is that of the range.
std::string interval_text(const FittedParameter& parameter) {
  const std::string low = number(parameter.interval->first), high = number(parameter.interval->second);
  if (parameter.is_low_open && !parameter.is_high_open) return "at most " + high;
  if (parameter.is_high_open && !parameter.is_low_open) return "at least " + low;
  return fmt::format("{} to {}", low, high);
}

std::string parameter_text(const FittedParameter& parameter) {
  std::string text = fmt::format("  {} = {}{}{}", parameter.key, number(parameter.number),
                                 parameter.unit.empty() || parameter.unit == "1" ? "" : " ",
                                 parameter.unit == "1" ? "" : parameter.unit);
  if (parameter.interval) text += ", 95 %: " + interval_text(parameter);
  if (parameter.is_at_bound) text += "; at the end of its range, so a better value may lie beyond";
  if (!parameter.unknown.empty()) text += fmt::format("; the data cannot tell it: {}", parameter.unknown);
  return text + "\n";
}

std::string errors_text(const std::string& which, const FitErrors& errors) {
  std::string text = fmt::format("  {}: {} trial{}", which, errors.trials, errors.trials == 1 ? "" : "s");
  const auto part = [&](const char* what, double mean, double spread, const std::string& unit) {
    if (std::isnan(mean)) return;
    text += fmt::format(", {} {}", what, three_digits(mean));
    if (errors.trials > 1) text += fmt::format(" ± {}", three_digits(spread));
    text += unit;
  };
  part("position", errors.position, errors.position_spread, errors.is_percent ? " %" : " m");
  part("rotation", errors.rotation, errors.rotation_spread, "°");
  if (errors.without_result > 0) text += fmt::format("; {} of them without result", errors.without_result);
  return text + "\n";
}

// Only pairs that cannot be told apart well.
std::string correlations_text(const FitResult& fit) {
  constexpr double kStrong = 0.5;
  std::string text;
  for (std::size_t i = 0; i < fit.correlations.size(); ++i) {
    for (std::size_t j = i + 1; j < fit.correlations.size(); ++j) {
      if (std::abs(fit.correlations[i][j]) < kStrong) continue;
      text += fmt::format("  {} and {} depend on each other: correlation {:.2f}\n", fit.parameters[i].key,
                          fit.parameters[j].key, fit.correlations[i][j]);
    }
  }
  return text;
}

std::string text_of(const RunName& run, const FitResult& fit) {
  std::string text = fmt::format("{}: {} values tried\n", run.text, fit.points);
  for (const FittedParameter& parameter : fit.parameters) text += parameter_text(parameter);
  if (!fit.why_no_intervals.empty()) text += "  " + fit.why_no_intervals + "\n";
  for (const std::string& caveat : fit.caveats) text += "  " + caveat + "\n";
  text += correlations_text(fit) + errors_text(fit.held_out ? "fitted" : "error", fit.training);
  if (fit.held_out) text += errors_text("held out", *fit.held_out);
  return text;
}

// The place of the recording stays known where the new file stands elsewhere.
std::string with_absolute_recording(std::string text, const Case& definition) {
  if (!definition.recording) return text;
  const TomlFile file = TomlFile::parse(text, definition.path);
  const TextRange range = file.root(case_keys()).at("truth").table(truth_keys()).at("file").range();
  const std::string path = std::filesystem::absolute(definition.recording->path).string();
  return text.replace(range.begin, range.end - range.begin, Json(path).dump());  // JSON's escapes are TOML's, too
}

void write_fitted(const FitRequest& asked, const Case& definition, const std::vector<SweepAxis>& axes,
                  const FitResult& fit, const Vocabulary& words) {
  std::string text = definition.text;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].kind == SweepAxis::Kind::scene) text = with_value(text, axes[i].key, fit.parameters[i].value);
  }
  text = with_absolute_recording(text, definition);
  read_case_text(text, asked.out, asked.out, words);
  write_file("--out", asked.out, text);
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (axes[i].kind != SweepAxis::Kind::scene)
      say(fmt::format("{} is no value of the scene: give it to the run, as --engine or --dt", axes[i].key));
  }
}

class FitCommand : public Command {
 public:
  void declare(Options& options) override { asked_.declare(options); }

  int run(const Invocation& invocation) override {
    asked_.invocation = invocation;
    const EngineTable engines = asked_.engines.outside.table(asked_.timeout.seconds);
    const Vocabulary words = vocabulary_of(engines.infos());
    FitInput input;
    input.cases = cases_of(asked_, words);
    for (const std::string& text : asked_.vary) input.axes.push_back(parse_axis(text, true));
    input.hold_out = asked_.hold_out, input.seed = asked_.seed.seed;
    input.jobs = asked_.jobs.count, input.limit = asked_.timeout.seconds;
    Json all = Json::array();
    for (const std::string& engine : asked_.engines.engines) {
      input.run = run_of_option(engine, engines.infos());
      const FitResult found = fitted(input, engines, words);
      if (asked_.json.is_on) {
        all.push_back(fit_json(input, found));
      } else {
        print_table(text_of(input.run, found));
      }
      if (!asked_.out.empty()) write_fitted(asked_, input.cases.front(), input.axes, found, words);
    }
    if (asked_.json.is_on) print(all.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    return kGood;
  }

 private:
  static FitResult fitted(FitInput input, const EngineTable& engines, const Vocabulary& words) {
    Progress progress("values of " + input.run.text);
    input.on_points = [&](std::size_t points) { progress.show(points, 0); };
    return fit(input, engines, words);
  }

  FitRequest asked_;
};

}  // namespace

CommandRow fit_row() {
  return {"fit",
          "fit scene values and options of an engine to a recording or another truth, with intervals",
          "CASE",
          kCases,
          {{"rigor fit reality/cube-tosses --engine bullet --vary scene.contact_default.friction=0.02..0.6",
            "the friction with which Bullet follows the tosses best"},
           {"rigor fit my-swing.toml --engine core:rk4 --vary scene.joint.pivot.friction=0..0.5",
            "from one recorded trial: the interval is that of the profile likelihood"},
           {"rigor fit reality/cube-tosses --engine mujoco --vary scene.contact_default.friction=0.02..0.6 --hold-out "
            "0.5",
            "the same, judged on tosses that took no part"}},
          make_command<FitCommand>};
}

}  // namespace rigor::inline cli
