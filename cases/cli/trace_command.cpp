// rigor trace prints one run in a chosen format, rigor truth prints the truth as CSV. Both work in a child process,
// because an engine may crash and a truth may take too long.
#include <fmt/format.h>

#include <algorithm>

#include "cases/cli/chosen_cases.h"
#include "cases/cli/commands.h"
#include "cases/cli/options.h"
#include "cases/cli/output.h"
#include "cases/cli/vocabulary.h"
#include "cases/report/csv/trajectory_csv.h"
#include "cases/report/trace/trace_formats.h"
#include "cases/runner/grid.h"
#include "cases/runner/process_pool.h"
#include "cases/runner/simulate.h"
#include "cases/truth/provenance.h"
#include "cases/truth/truth.h"
#include "core/base/error.h"
#include "core/engine/engine_failure.h"

namespace rigor {
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

void send_trajectory(const Simulation& run, const Scene& scene, int every, TraceWriter& writer,
                     const Channel& channel) {
  const std::string start(1, kData);
  std::string data = start + writer.begin();
  for (std::size_t i = 0; i < run.trajectory.samples.size(); i += every) {
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

}  // namespace

Case the_case(const CommandLine& line, const EngineTable& engines) {
  if (line.words.empty())
    throw InputError(fmt::format("rigor {}: takes one case; rigor list cases names them", line.command));
  std::vector<Case> cases = chosen_cases(line, vocabulary_of(engines.infos()));
  if (cases.size() == 1) return cases.front();
  throw InputError(
      fmt::format("rigor {}: takes one case, and {} names {} of them", line.command, line.words.front(), cases.size()));
}

static int trace_command(const CommandLine& line, const EngineTable& engines) {
  Case definition = the_case(line, engines);
  if (line.engines.size() != 1) throw InputError("rigor trace: takes exactly one --engine; see rigor list engines");
  const std::vector<StepSize> steps = line.dt.empty() ? definition.dt : line.dt;
  if (steps.size() != 1) throw InputError("rigor trace: takes exactly one --dt; " + steps_of(definition));
  const TraceFormat& format = line.format.empty() ? trace_formats().front() : find_trace_format(line.format);
  if (line.contacts && !line.format.empty() && line.format != "csv")
    throw InputError(fmt::format("rigor trace: --contacts prints CSV; --format {} has no contacts", line.format));
  override_run(definition, {steps, line.duration});
  const RunName run = run_of_option(line.engines.front(), engines.infos());
  const Engine& engine = engines.find(run.engine);
  const double dt = steps.front().seconds;
  const std::string why = why_unsupported(engines.info_of(run.engine), run.settings, definition.scene, dt);
  if (!why.empty()) throw InputError(fmt::format("{}: unsupported: {}", run.text, why));
  return print_from_child(run.text, line.limit, [&](const Channel& channel) {
    try {
      const Simulation done =
          simulate(engine, run.settings, definition.scene, dt, definition.duration, {.has_contacts = line.contacts});
      if (line.contacts && !done.trajectory.has_contacts)
        throw InputError(fmt::format("{}: unsupported: the engine does not report contact forces here", run.text));
      const auto writer = line.contacts ? contacts_trace(definition.scene) : format.writer(definition.scene);
      send_trajectory(done, definition.scene, line.every, *writer, channel);
    } catch (const EngineFailure& failure) {
      if (failure.kind() != FailureKind::unsupported) throw;
      throw InputError(fmt::format("{}: unsupported: {}", run.text, failure.what()));
    }
    engines.rest();
  });
}

static int truth_command(const CommandLine& line, const EngineTable& engines) {
  Case definition = the_case(line, engines);
  if (definition.truth == "none")
    throw InputError(fmt::format("{}: the case states no truth (truth.kind is \"none\")", definition.id));
  if (line.duration) definition.duration = *line.duration;
  std::vector<double> times = line.times;
  if (times.empty()) override_run(definition, {}), times = times_of_run(definition);
  const double end = std::max(definition.duration, *std::max_element(times.begin(), times.end()));
  say(fmt::format("the truth '{}' is {}", definition.truth, provenance_of(definition.truth)));
  return print_from_child("the truth of " + definition.id, line.limit, [&](const Channel& channel) {
    send_truth(*make_truth(definition.truth, definition.scene, end), definition.scene, times, channel);
  });
}

CommandRow trace_row() {
  return {"trace",
          "print one trajectory as CSV, JSON lines, MCAP or glTF",
          "CASE",
          "a case or a file",
          with_import_options({"--contacts", "--dt", "--duration", "--engine", "--every", "--format", "--plugin",
                               "--suite", "--timeout"}),
          {{"rigor trace springs/fixed-spring --engine ode --dt 1/240 > ode.csv", "a table of all samples"},
           {"rigor trace robot.urdf --engine core:rk4 --dt 1/240 --format gltf > robot.gltf", "an animation"},
           {"rigor trace ballistic/fast-spin --engine bullet --dt 1/60 --every 6", "each sixth sample"},
           {"rigor trace contact/lying-still --engine ode --dt 1/240 --contacts", "contact forces of each step"}},
          trace_command};
}

CommandRow truth_row() {
  return {"truth",
          "print the states of the truth and its own error as CSV",
          "CASE",
          "a case or a file",
          with_import_options({"--duration", "--suite", "--timeout", "--times"}),
          {{"rigor truth springs/fixed-spring", "at every coarsest step of the run"},
           {"rigor truth springs/fixed-spring --times 1,2,5/2", "at three instants"}},
          truth_command};
}

}  // namespace rigor
