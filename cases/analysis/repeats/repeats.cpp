#include "cases/analysis/repeats/repeats.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "cases/analysis/divergence/parting_bounds.h"
#include "cases/runner/process_pool.h"
#include "core/base/error.h"
#include "core/base/json.h"
#include "core/engine/simulation.h"

namespace rigor::inline analysis {
namespace {

// A difference like this many times that of one rounding is one of a few roundings that the motion amplifies.
constexpr double kRoundings = 100;

std::string packed_states(const RecordedStates& states) {
  const std::uint64_t bodies = states.bodies;
  std::string text(sizeof bodies, '\0');
  std::memcpy(text.data(), &bodies, sizeof bodies);
  return text.append(reinterpret_cast<const char*>(states.values.data()), states.values.size() * sizeof(double));
}

RecordedStates unpacked_states(const std::string& text) {
  RecordedStates states;
  std::uint64_t bodies = 0;
  std::memcpy(&bodies, text.data(), sizeof bodies);
  states.bodies = bodies;
  states.values.resize((text.size() - sizeof bodies) / sizeof(double));
  std::memcpy(states.values.data(), text.data() + sizeof bodies, states.values.size() * sizeof(double));
  return states;
}

struct TextOrWhy {
  std::string text, why;
};

TextOrWhy text_from_child(const EngineTable& engines, double limit, const std::function<std::string()>& work) {
  TextOrWhy answer;
  const auto on_message = [&](std::size_t, const std::string& text) { answer.text = text; };
  const auto on_end = [&](std::size_t, const JobEnd& end) {
    if (end.how != Ending::finished) answer.why = end.how == Ending::refused ? end.text : sentence_of(end, limit);
  };
  const Job job{[&](const Channel& channel) {
                  channel.send(work());
                  engines.rest();
                },
                limit};
  run_jobs({job}, 1, on_message, on_end);
  return answer;
}

struct StatesOrWhy {
  RecordedStates states;
  std::string why;
};

StatesOrWhy states_from_child(const EngineTable& engines, double limit, const std::function<RecordedStates()>& work) {
  const TextOrWhy answer = text_from_child(engines, limit, [&] { return packed_states(work()); });
  if (answer.text.empty()) return {{}, answer.why};
  return {unpacked_states(answer.text), answer.why};
}

bool saves_state(const EngineTable& engines, const RunName& run, const Scene& scene, double limit) {
  const auto work = [&] {
    const auto world = engines.find(run.engine).load(scene, run.settings);
    return std::string(world->capabilities().state ? "yes" : "no");
  };
  const TextOrWhy answer = text_from_child(engines, limit, work);
  if (!answer.why.empty()) throw InputError(fmt::format("{}: {}", run.text, answer.why));
  return answer.text == "yes";
}

// One rounding of each coordinate.
Scene rounded_differently(const Scene& scene) {
  Scene out = scene;
  for (Body& body : out.bodies) {
    if (body.fixed) continue;
    for (int k = 0; k < 3; ++k) {
      const double x = body.position[k];
      body.position[k] = x == 0 ? 0x1p-53 : std::nextafter(x, HUGE_VAL);
    }
  }
  return out;
}

// As a child sends it.
Json json_of_difference(const std::optional<BitDifference>& difference) {
  if (!difference) return nullptr;
  // Infinity has no JSON; the largest double stands for it.
  const auto number = [](double x) { return std::isfinite(x) ? x : std::numeric_limits<double>::max(); };
  return {difference->step,
          difference->body,
          difference->column,
          number(difference->there),
          number(difference->position),
          number(difference->angle),
          number(difference->rounding),
          number(difference->far_rounding)};
}

std::optional<BitDifference> difference_in(const Json& json) {
  if (json.is_null()) return {};
  return BitDifference{json.at(0), json.at(1), json.at(2), json.at(3), json.at(4), json.at(5), json.at(6), json.at(7)};
}

constexpr const char *kNewProcess = "new-process", *kCLibrary = "c-library";

bool is_chosen(const RepeatOptions& options, const std::string& change) {
  const auto& names = options.changes;
  return names.empty() || std::find(names.begin(), names.end(), change) != names.end();
}

class Repeater {
 public:
  Repeater(const EngineTable& engines, const RepeatedRun& run, const RecordedStates& base, const RepeatOptions& options)
      : engines_(engines), run_(run), base_(base), options_(options) {}

  std::vector<RepeatOutcome> all() {
    std::vector<Job> jobs;
    std::vector<std::size_t> first;
    for (const RepeatChange& change : repeat_changes()) {
      if (!is_chosen(options_, change.name)) continue;
      std::string why;
      const std::vector<ChangedRun> runs = change.runs(run_, why);
      first.push_back(outcomes_.size());
      if (runs.empty()) add(change, "", why);
      for (const ChangedRun& one : runs) add(change, one.label, one.found ? "no answer" : one.why_not);
      if (!runs.empty()) jobs.push_back(job_of(runs));
      if (runs.empty()) first.pop_back();
    }
    const auto on_message = [&](std::size_t job, const std::string& text) { take(first[job], parse_json(text)); };
    std::size_t done = 0;
    const auto on_end = [&](std::size_t job, const JobEnd& end) {
      if (options_.on_changes) options_.on_changes(++done, jobs.size());
      if (end.how == Ending::finished) return;
      for (std::size_t n = first[job]; n < outcomes_.size() && outcomes_[n].change == outcomes_[first[job]].change;
           ++n) {
        if (!outcomes_[n].is_run) fail(outcomes_[n], end);
      }
    };
    run_jobs(jobs, options_.jobs, on_message, on_end);
    return outcomes_;
  }

 private:
  void add(const RepeatChange& change, const std::string& label, const std::string& why) {
    RepeatOutcome outcome;
    outcome.change = change.name, outcome.label = label, outcome.must_hold = change.must_hold, outcome.why = why;
    outcomes_.push_back(outcome);
  }

  // An engine may refuse a larger scene. One that crashes there, or does not end, has failed.
  void fail(RepeatOutcome& outcome, const JobEnd& end) const {
    const auto& changes = repeat_changes();
    const auto change = std::find_if(changes.begin(), changes.end(),
                                     [&](const RepeatChange& row) { return row.name == outcome.change; });
    const bool has_refused = change->enlarges && (end.how == Ending::threw || end.how == Ending::refused);
    outcome.has_failed = !has_refused;
    outcome.why = (has_refused ? "the engine cannot run so large a scene: " : "") + sentence_of(end, options_.limit);
  }

  // The runs of one change, in a process of their own.
  Job job_of(const std::vector<ChangedRun>& runs) const {
    return {[this, runs](const Channel& channel) {
              for (std::size_t n = 0; n < runs.size(); ++n) {
                if (!runs[n].found) continue;
                const RecordedStates found = runs[n].found();
                const auto difference = first_difference(runs[n].due ? runs[n].due() : base_, found);
                channel.send(Json{{"run", n}, {"difference", json_of_difference(difference)}}.dump());
              }
              engines_.rest();
            },
            options_.limit};
  }

  void take(std::size_t first, const Json& answer) {
    RepeatOutcome& outcome = outcomes_[first + answer.at("run").get<std::size_t>()];
    outcome.is_run = true, outcome.why.clear();
    outcome.difference = difference_in(answer.at("difference"));
    if (outcome.difference) outcome.body = run_.scene.bodies[outcome.difference->body].name;
  }

  const EngineTable& engines_;
  const RepeatedRun& run_;
  const RecordedStates& base_;
  const RepeatOptions& options_;
  std::vector<RepeatOutcome> outcomes_;
};

// In a new process, of which only the hashes are known.
RepeatOutcome in_new_process(const std::string& change, const std::vector<std::uint64_t>& due,
                             const HashesElsewhere& elsewhere, const std::string& environment = "") {
  RepeatOutcome outcome;
  outcome.change = change;
  if (!elsewhere) {
    outcome.why = "no program is there to start";
    return outcome;
  }
  const std::vector<std::uint64_t> found = elsewhere(environment);
  outcome.is_run = true;
  const auto at = std::mismatch(due.begin(), due.end(), found.begin(), found.end());
  if (at.first != due.end() || at.second != found.end()) {
    outcome.difference = BitDifference{};
    outcome.difference->step = at.first - due.begin(), outcome.difference->column = -1;
  }
  return outcome;
}

// glibc chooses its sine, exponential and the like by the processor. This variable makes it choose as on one without
// AVX2 and FMA; other code of the process is not affected.
RepeatOutcome with_older_c_library(const std::vector<std::uint64_t>& due, const RepeatOptions& options,
                                   const EngineInfo& engine) {
  RepeatOutcome outcome;
  outcome.change = kCLibrary;
#if defined(__GLIBC__) && defined(__x86_64__)
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
    outcome = in_new_process(kCLibrary, due, options.elsewhere,
                             "GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2,-FMA,-FMA4,-AVX512F,-AVX");
  else
    outcome.why = "this processor has neither AVX2 nor FMA";
#else
  outcome.why = "only glibc on x86-64 can be told to use an older processor's instructions";
#endif
  outcome.must_hold = engine.name == "core";  // which takes no such function from the C library
  return outcome;
}

// A difference counts as rounding if it begins as a few roundings and stays small. The limit at the end is a multiple
// of what one rounding of the start makes, or of one rounding of the coordinates.
void compare_with_rounding(RepeatReport& report, double size) {
  for (RepeatOutcome& outcome : report.outcomes) {
    if (!outcome.difference || outcome.difference->column < 0) continue;
    const BitDifference& difference = *outcome.difference;
    const bool is_small = difference.there <= kRoundings * std::max(difference.rounding, 0x1p-52);
    const double position = std::max(report.rounding_position, difference.far_rounding),
                 angle = std::max(report.rounding_angle, difference.far_rounding / size);
    outcome.is_like_rounding =
        is_small && difference.position <= kRoundings * position && difference.angle <= kRoundings * angle;
  }
}

}  // namespace

std::vector<std::string> change_names() {
  std::vector<std::string> names;
  for (const RepeatChange& change : repeat_changes()) names.push_back(change.name);
  names.insert(names.begin() + 1, kNewProcess), names.emplace_back(kCLibrary);
  return names;
}

bool RepeatReport::repeats() const {
  return std::none_of(outcomes.begin(), outcomes.end(), [](const RepeatOutcome& one) { return one.breaks(); });
}

RecordedStates base_states(const EngineTable& engines, const Case& definition, const RunName& run, const StepSize& dt,
                           double limit) {
  const std::string why = why_unsupported(engines.info_of(run.engine), run.settings, definition.scene, dt.seconds);
  if (!why.empty()) throw InputError(fmt::format("{}: unsupported: {}", run.text, why));
  const long steps = steps_in(definition.duration, dt.seconds);
  constexpr double kMostBytes = 1e9;
  const double bytes = 8.0 * RecordedStates::kColumns * static_cast<double>(definition.scene.bodies.size()) *
                       static_cast<double>(steps + 1);
  if (bytes > kMostBytes)
    throw InputError(fmt::format("{}: {} steps of {} bodies take {:.2g} bytes; use a shorter --duration", definition.id,
                                 steps, definition.scene.bodies.size(), bytes));
  StatesOrWhy base = states_from_child(engines, limit, [&] {
    return recorded(engines.find(run.engine), run.settings, definition.scene, dt.seconds, steps);
  });
  if (!base.why.empty()) throw InputError(fmt::format("{}: {}", run.text, base.why));
  return std::move(base.states);
}

RepeatReport repeat(const EngineTable& engines, const Case& definition, const RunName& run, const StepSize& dt,
                    const RepeatOptions& options) {
  RepeatReport report{definition.id, run, dt, steps_in(definition.duration, dt.seconds), 0, 0, {}, {}};
  const RecordedStates base = base_states(engines, definition, run, dt, options.limit);
  report.hashes = hashes_of(base);
  const Engine& engine = engines.find(run.engine);
  const RepeatedRun repeated{engine,
                             engines.info_of(run.engine),
                             run,
                             definition.scene,
                             dt.seconds,
                             report.steps,
                             saves_state(engines, run, definition.scene, options.limit)};
  report.outcomes = Repeater(engines, repeated, base, options).all();
  if (is_chosen(options, kNewProcess)) {
    const auto first = report.outcomes.begin();
    const bool stands_behind_one = !report.outcomes.empty() && first->change == repeat_changes().front().name;
    report.outcomes.insert(first + stands_behind_one, in_new_process(kNewProcess, report.hashes, options.elsewhere));
  }
  if (is_chosen(options, kCLibrary))
    report.outcomes.push_back(with_older_c_library(report.hashes, options, repeated.info));
  const bool some_differ = std::any_of(report.outcomes.begin(), report.outcomes.end(),
                                       [](const RepeatOutcome& one) { return one.difference.has_value(); });
  if (!some_differ) return report;
  const Scene nudged = rounded_differently(definition.scene);
  const StatesOrWhy other = states_from_child(
      engines, options.limit, [&] { return recorded(engine, run.settings, nudged, dt.seconds, report.steps); });
  if (!other.why.empty() || other.states.samples() != base.samples()) return report;
  const PoseDistance end = pose_distance(base, other.states, base.samples() - 1);
  report.rounding_position = end.position, report.rounding_angle = end.angle;
  compare_with_rounding(report, scene_size(definition.scene));
  return report;
}

}  // namespace rigor::inline analysis
