// rigor trace prints one run in a chosen format, rigor truth prints the truth as CSV. Both work in a child process,
// because an engine may crash and a truth may take too long.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "cases/cli/chosen_cases.h"
#include "cases/cli/commands.h"
#include "cases/cli/output.h"
#include "cases/cli/vocabulary.h"
#include "cases/metrics/measures/joints/joint_reactions.h"
#include "cases/report/csv/reaction_csv.h"
#include "cases/report/csv/trajectory_csv.h"
#include "cases/report/trace/trace_formats.h"
#include "cases/runner/grid.h"
#include "cases/runner/process_pool.h"
#include "cases/runner/simulate.h"
#include "cases/truth/provenance.h"
#include "cases/truth/recorded/recorded_motion.h"
#include "core/base/error.h"
#include "core/base/names_of.h"
#include "core/engine/engine_failure.h"

namespace rigor::inline cli {
namespace {

constexpr std::size_t kChunk = 1 << 20;  // bytes of rows sent at a time

// The first byte of a message: a line for stderr, or data.
constexpr char kNote = '\x01', kData = '\x02';

// Runs the work in a child and prints its messages. Returns the exit code.
int print_from_child(const std::string& what, double limit, const std::function<void(const Channel&)>& work) {
  int code = kGood;
  const auto on_message = [](std::size_t, const std::string& message) {
    message.starts_with(kNote) ? say(message.substr(1)) : print(message.substr(1));
  };
  const auto on_end = [&](std::size_t, const JobEnd& end) {
    if (end.how == Ending::finished) return;
    if (end.how == Ending::refused) throw InputError(end.text);
    say(fmt::format("{}: {}", what, sentence_of(end, limit)));
    code = kBroken;
  };
  run_jobs({{work, limit}}, 1, on_message, on_end);
  return code;
}

// The rows of a trace are held in memory until the run has ended.
void refuse_too_many_rows(const Scene& scene, double steps, int every) {
  constexpr double kMostBytes = 4e9, kBytesOfBody = 14 * sizeof(double);
  const double bytes = steps / every * kBytesOfBody * static_cast<double>(scene.bodies.size());
  if (bytes <= kMostBytes) return;
  throw InputError(fmt::format("rigor trace: {:.3g} steps would take {:.3g} GB of memory; allowed: --every {:.0f}",
                               steps, bytes / 1e9, std::ceil(every * bytes / kMostBytes)));
}

// `samples` of the run: a last one between two multiples of --every is left out.
void send_trajectory(const Simulation& run, const Scene& scene, std::size_t samples, TraceWriter& writer,
                     const Channel& channel) {
  const std::string start(1, kData);
  const std::size_t all = std::min(samples, run.trajectory.samples.size());
  std::string data = start + writer.begin(all);
  for (std::size_t i = 0; i < all; ++i) {
    data += writer.add(run.trajectory.samples[i]);
    if (data.size() > kChunk) channel.send(data), data = start;
  }
  channel.send(data + writer.end());
  if (run.not_finite) {
    channel.send(fmt::format("{}blown up: from {:.6g} s on the state of '{}' is not finite", kNote,
                             run.not_finite->time, scene.body_name(run.not_finite->body)));
  }
  if (!run.solver_warning.empty()) {
    channel.send(fmt::format("{}after {:.6g} s the solver no longer met its tolerance: {}", kNote,
                             run.solver_warning_time, run.solver_warning));
  }
}

void send_truth(const Truth& truth, const Scene& scene, const std::vector<double>& times, const Channel& channel) {
  const std::string start(1, kData);
  std::string rows = start + csv_header() + ",error\n";
  BodyTable bodies(scene.bodies.size());
  for (const double time : times) {
    truth.at(time, bodies.columns());
    append_csv_rows(rows, scene, time, bodies.columns(), fmt::format(",{:.17g}", truth.error(time)));
    if (rows.size() > kChunk) channel.send(rows), rows = start;
  }
  channel.send(rows);
}

// What joints carry at the truth's instants; a singular position has no such value.
void send_truth_reactions(const Truth& truth, const Scene& scene, const std::vector<double>& times,
                          const Channel& channel) {
  JointReactions reactions(scene);
  std::vector<JointGeometry> geometry;
  for (const Joint& joint : scene.joints) geometry.emplace_back(scene, joint);
  std::string rows = std::string(1, kData) + kReactionHeader;
  BodyTable bodies(scene.bodies.size());
  for (const double time : times) {
    truth.at(time, bodies.columns());
    const auto carried = reactions.at(bodies.columns(), time);
    if (!carried) {
      channel.send(fmt::format("{}at {:.6g} s the joints' position is singular; left out", kNote, time));
      continue;
    }
    for (std::size_t k = 0; k < scene.joints.size(); ++k) {
      append_reaction_row(rows, scene, scene.joints[k], time, end_motion(geometry[k].b(), bodies.columns()).point(),
                          (*carried)[k]);
    }
  }
  channel.send(rows);
}

std::string steps_of(const Case& definition) {
  std::vector<std::string> texts;
  for (const StepSize& step : definition.dt) texts.push_back(step.text);
  return fmt::format("{} has {}", definition.id, fmt::join(texts, ", "));
}

// The instants of the run in its coarsest steps.
std::vector<double> times_of_run(const Case& definition) {
  double dt = 0;
  for (const StepSize& step : definition.dt) dt = std::max(dt, step.seconds);
  std::vector<double> times;
  for (long n = 0; n <= steps_in(definition.duration, dt); ++n) times.push_back(n * dt);
  return times;
}

std::vector<double> parse_times(const std::string& text) {
  std::vector<double> times;
  std::size_t at = 0;
  while (at <= text.size()) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::string word = text.substr(at, comma - at);
    const bool is_zero =
        !word.empty() && word.find_first_not_of("0.") == std::string::npos && word.find('0') != std::string::npos;
    times.push_back(is_zero ? 0.0 : parse_step_size(word, "--times").seconds);
    at = comma + 1;
  }
  return times;
}

class TraceCommand : public Command {
 public:
  void declare(Options& options) override {
    cases_.declare(options), engine_.declare(options), steps_.declare(options), duration_.declare(options);
    timeout_.declare(options);
    options.add({"--every", "N", "print only each N-th sample"},
                [this](const std::string& text) { every_ = parse_count(text, "--every"); });
    options.add_flag("--contacts",
                     "print the contact forces of each step: in CSV in place of the bodies, else beside them",
                     contacts_);
    options.add_flag("--reactions",
                     "print as CSV what the engine says that each joint carries, from the second step on", reactions_);
    options.add({"--format", "F", either_of(names_of(trace_formats())) + "; default: csv", names_of(trace_formats())},
                format_);
  }

  int run(const Invocation& invocation) override {
    const EngineTable engines = engine_.outside.table(timeout_.seconds);
    Case definition = the_case(cases_, invocation, engines);
    if (engine_.engines.size() != 1)
      throw InputError("rigor trace: takes exactly one --engine; see rigor list engines");
    const std::vector<StepSize> steps = steps_.dt.empty() ? definition.dt : steps_.dt;
    if (steps.size() != 1) throw InputError("rigor trace: takes exactly one --dt; " + steps_of(definition));
    const TraceFormat& format = format_.empty() ? trace_formats().front() : find_trace_format(format_);
    if (reactions_) refuse_beside_reactions();
    override_run(definition, {steps, duration_.seconds});
    const RunName run = run_of_option(engine_.engines.front(), engines.infos());
    const Engine& engine = engines.find(run.engine);
    const double dt = steps.front().seconds;
    const std::string why = why_unsupported(engines.info_of(run.engine), run.settings, definition.scene, dt);
    if (!why.empty()) throw InputError(fmt::format("{}: unsupported: {}", run.text, why));
    const long count = steps_in(definition.duration, dt);
    refuse_too_many_rows(definition.scene, static_cast<double>(count), every_);
    return print_from_child(run.text, timeout_.seconds, [&](const Channel& channel) {
      try {
        const Simulation done = simulate(engine, run.settings, definition.scene, dt, definition.duration,
                                         {.steps_per_sample = every_,
                                          .is_timed = false,
                                          .reactions_every = reactions_ ? 1 : 0,
                                          .has_contacts = contacts_});
        if (reactions_) refuse_unreported(done, definition.scene, run.text);
        if (contacts_ && done.trajectory.contacts != ContactRecords::kept)
          throw InputError(fmt::format("{}: unsupported: the engine does not report contact forces here", run.text));
        const auto writer = reactions_ ? reactions_trace(definition.scene) : format.writer(definition.scene, contacts_);
        send_trajectory(done, definition.scene, static_cast<std::size_t>(count / every_) + 1, *writer, channel);
      } catch (const EngineFailure& failure) {
        if (failure.kind() != FailureKind::unsupported) throw;
        throw InputError(fmt::format("{}: unsupported: {}", run.text, failure.what()));
      }
      engines.rest();
    });
  }

 private:
  void refuse_beside_reactions() const {
    if (every_ != 1) throw InputError("rigor trace: --reactions takes no --every; it prints each step");
    if (contacts_) throw InputError("rigor trace: --reactions and --contacts are two tables; ask for one of them");
    if (!format_.empty() && format_ != "csv") throw InputError("rigor trace: --reactions is written as csv only");
  }
  static void refuse_unreported(const Simulation& run, const Scene& scene, const std::string& name) {
    if (scene.joints.empty()) throw InputError("rigor trace: --reactions: the case has no joints");
    const std::vector<Sample>& samples = run.trajectory.samples;
    if (samples.size() < 3) throw InputError("rigor trace: --reactions needs a run of two steps or more");
    if (samples[2].reactions.empty())
      throw InputError(name + ": unsupported: the engine does not say what its joints carry here");
  }

  CaseWords cases_;
  EngineOptions engine_;
  StepOption steps_;
  DurationOption duration_;
  TimeoutOption timeout_;
  int every_ = 1;
  bool contacts_ = false, reactions_ = false;
  std::string format_;  // empty: the default
};

class TruthCommand : public Command {
 public:
  void declare(Options& options) override {
    cases_.declare(options), duration_.declare(options), timeout_.declare(options);
    options.add({"--times", "T,T...", "instants in s; default: every coarsest step of the run"},
                [this](const std::string& text) { times_ = parse_times(text); });
    options.add_flag("--reactions", "print what each joint carries, in place of the bodies", reactions_);
  }

  int run(const Invocation& invocation) override {
    Case definition = the_case(cases_, invocation, built_in_engines());
    if (definition.truth == "none")
      throw InputError(fmt::format("{}: the case states no truth (truth.kind is \"none\")", definition.id));
    if (reactions_) {
      const std::string why = definition.truth == "recording" ? "a recording does not say what joints carry"
                                                              : why_reactions_are_unknown(definition.scene);
      if (!why.empty()) throw InputError(fmt::format("{}: --reactions: {}", definition.id, why));
    }
    if (duration_.seconds) definition.duration = *duration_.seconds;
    std::vector<double> times = times_;
    if (times.empty()) override_run(definition, {}), times = times_of_run(definition);
    const double end = std::max(definition.duration, *std::max_element(times.begin(), times.end()));
    say(fmt::format("the truth '{}' is {}", definition.truth, provenance_of(definition.truth)));
    return print_from_child("the truth of " + definition.id, timeout_.seconds, [&](const Channel& channel) {
      const auto truth = truth_of(definition, end);
      if (!truth->caveat().empty()) channel.send(kNote + truth->caveat());
      (reactions_ ? send_truth_reactions : send_truth)(*truth, definition.scene, times, channel);
    });
  }

 private:
  CaseWords cases_;
  DurationOption duration_;
  TimeoutOption timeout_;
  std::vector<double> times_;  // s
  bool reactions_ = false;
};

}  // namespace

Case the_case(const CaseWords& cases, const Invocation& invocation, const EngineTable& engines) {
  if (cases.words.empty())
    throw InputError(fmt::format("rigor {}: takes one case; rigor list cases names them", invocation.command));
  std::vector<Case> chosen = chosen_cases(cases, invocation, vocabulary_of(engines.infos()));
  if (chosen.size() == 1) return chosen.front();
  throw InputError(fmt::format("rigor {}: takes one case, and {} names {} of them", invocation.command,
                               cases.words.front(), chosen.size()));
}

CommandRow trace_row() {
  return {"trace",
          "print one trajectory as CSV, JSON lines, MCAP, glTF or NumPy's array",
          "CASE",
          "a case or a file",
          {{"rigor trace springs/fixed-spring --engine ode --dt 1/240 > ode.csv", "a table of all samples"},
           {"rigor trace robot.urdf --engine core:rk4 --dt 1/240 --format gltf > robot.gltf", "an animation"},
           {"rigor trace ballistic/fast-spin --engine bullet --dt 1/60 --every 6", "each sixth sample"},
           {"rigor trace contact/lying-still --engine ode --dt 1/240 --contacts", "contact forces of each step"}},
          make_command<TraceCommand>};
}

CommandRow truth_row() {
  return {"truth",
          "print the states of the truth and its own error as CSV",
          "CASE",
          "a case or a file",
          {{"rigor truth springs/fixed-spring", "at every coarsest step of the run"},
           {"rigor truth springs/fixed-spring --times 1,2,5/2", "at three instants"},
           {"rigor truth joints/pendulum-90 --reactions", "force and couple on each joint's second body"}},
          make_command<TruthCommand>};
}

}  // namespace rigor::inline cli
