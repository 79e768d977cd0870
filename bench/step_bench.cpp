// Steps of every engine and method on every scene of scenes.cpp. Each timing begins with a fresh world, unless the
// scene moves forever. It takes the same number of steps with every engine, so that all time the same interval of
// motion. The checksum of the final positions shows that the work was done.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <malloc.h>
#include <time.h>

#include <algorithm>
#include <limits>
#include <map>

#include "bench/benchmarks.h"
#include "bench/reached.h"
#include "bench/scenes.h"
#include "cases/runner/grid.h"
#include "core/engine/engine_failure.h"

namespace rigor::bench {
namespace {

double seconds_by(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double heap_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
}

struct Subject {
  const SceneRow* row;
  int count;
  RunName run;
  const Engine* engine;
  bool by_wall;  // to compare numbers of threads
};

// A step includes reading the state, because users of an engine read it after each step.
double run_interval(World& world, Snapshot& snapshot, int steps, double dt, bool by_wall) {
  const double start = by_wall ? wall_seconds() : thread_seconds();
  for (int n = 0; n < steps; ++n) {
    world.step(dt);
    world.read(snapshot);
    benchmark::DoNotOptimize(snapshot.bodies().column(0));
  }
  return (by_wall ? wall_seconds() : thread_seconds()) - start;
}

// Results that do not depend on the length of the timing; computed once for each subject.
struct Facts {
  double bytes_per_body, checksum;
  Figures reached;
};

const Facts& facts_of(const Subject& subject, const std::string& name) {
  static std::map<std::string, Facts> known;
  const auto [at, is_new] = known.try_emplace(name);
  if (!is_new) return at->second;
  const Scene& scene = scene_of(*subject.row, subject.count);
  const double before = heap_in_use();
  const auto world = subject.engine->load(scene, subject.run.settings);
  at->second.bytes_per_body = (heap_in_use() - before) / subject.count;
  Snapshot snapshot;
  constexpr int kSteps = 20;
  run_interval(*world, snapshot, std::min(kSteps, steps_of_interval(*subject.row, subject.count)), subject.row->dt,
               false);
  double sum = 0;
  for (std::size_t i = 0; i < snapshot.bodies().size(); ++i) sum += snapshot.bodies().position(i).sum();
  at->second.checksum = sum;
  // However many threads take a step, it is the same step.
  if (!subject.by_wall)
    at->second.reached = reached(*subject.row, subject.count, *subject.engine, subject.run.settings);
  return at->second;
}

void time_steps(benchmark::State& state, const Subject& subject, const std::string& name) {
  const SceneRow& row = *subject.row;
  const Scene& scene = scene_of(row, subject.count);
  const std::string obstacle = why_unsupported(subject.engine->info(), subject.run.settings, scene, row.dt);
  if (!obstacle.empty()) {
    state.SkipWithError(obstacle.c_str());
    return;
  }
  const int steps = steps_of_interval(row, subject.count);
  const Facts& facts = facts_of(subject, name);
  auto world = subject.engine->load(scene, subject.run.settings);
  Snapshot snapshot;
  bool used = false;
  double seconds = 0, least = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    if (used && !row.goes_on) world = subject.engine->load(scene, subject.run.settings);
    if (!used && row.goes_on) run_interval(*world, snapshot, 1, row.dt, false);  // touches its memory
    used = true;
    const double taken = run_interval(*world, snapshot, steps, row.dt, subject.by_wall);
    seconds += taken;
    least = std::min(least, taken);
    state.SetIterationTime(taken);
  }
  // Other load only adds to wall time. The shortest of several stretches is therefore the best estimate.
  if (subject.by_wall) seconds = least * static_cast<double>(state.iterations());
  const auto body_steps = static_cast<double>(state.iterations()) * steps * subject.count;
  state.counters["ns_per_body_step"] = 1e9 * seconds / body_steps;
  state.counters["body_steps_per_second"] = body_steps / seconds;
  state.counters["bytes_per_body"] = facts.bytes_per_body;
  state.counters["checksum"] = facts.checksum;
  for (const auto& [what, value] : facts.reached)
    if (std::isfinite(value)) state.counters[what] = value;
}

// If an engine refuses the scene, at once or by its own limits, or fails after the start, its row also says so.
void time_or_skip(benchmark::State& state, const Subject& subject, const std::string& name) {
  try {
    time_steps(state, subject, name);
  } catch (const std::runtime_error& failure) {
    state.SkipWithError(failure.what());
  }
}

// Every method of every engine; Bullet and ODE on the matched track. Also the core on one and on two threads, in wall
// time.
std::vector<RunName> runs(const std::string& filter) {
  const std::vector<EngineInfo> infos = infos_of(engines());
  std::vector<RunName> all;
  for (const EngineInfo& info : infos) {
    if (is_on_request(info.name) && filter != "." && filter.find(info.name) == std::string::npos) continue;
    for (const MethodInfo& method : info.methods) {
      if (!method.twin_of.empty()) continue;  // a twin is an instrument; its speed does not matter
      all.push_back(parse_run_name(info.name + ":" + method.name, infos));
      for (const OptionInfo& option : method.options) {
        if (option.name == "threads") {
          for (const int threads : {1, 2})
            all.push_back(parse_run_name(fmt::format("{}:{},threads={}", info.name, method.name, threads), infos));
        }
        if (option.name == "iterations" && method.name == "quickstep")
          all.push_back(parse_run_name(fmt::format("{}:{},iterations=50", info.name, method.name), infos));
        const bool piles_up = std::count(option.choices.begin(), option.choices.end(), "impulse") > 0;
        if (option.name == "contact" && piles_up) {
          for (const char* more : {"", ",threads=1", ",threads=2", ",substeps=2"})
            all.push_back(parse_run_name(fmt::format("{}:{},contact=impulse{}", info.name, method.name, more), infos));
        }
      }
    }
  }
  return all;
}

// Half a gigabyte of bodies is too much for Bullet and ODE. For large piles only the growth of the core's cost is of
// interest. ODE's direct solver takes 3 ms for a step of 216 balls, and its cost grows with the cube of the balls. More
// sweeps than the engine's default are for joints.
bool fits(const SceneRow& row, const RunName& run, int count) {
  const bool is_jointed = row.reached == Reached::joint_gap, is_heap = row.reached == Reached::penetration;
  const auto& options = run.settings.options;
  if (row.reached == Reached::gap_and_overlap) {
    const bool is_plain_impulse = options.size() == 1 && options.contains("contact");
    return run.engine == "core" ? is_plain_impulse : run.settings.method != "worldstep" || count <= 100;
  }
  if (options.contains("threads") && options.contains("contact") && !is_heap) return false;
  if (options.contains("substeps") && (row.name != "pile" || count > 216)) return false;
  if (run.engine == "core") return !is_jointed || run.settings.options.empty();
  if (is_jointed) return run.settings.method != "worldstep" || count <= 100;
  if (run.settings.options.contains("iterations")) return false;
  if (row.reached != Reached::penetration) return count <= 100000;
  return count <= (run.settings.method == "worldstep" ? 216 : 2000);
}

// A pile takes 3 s and 10 s per round, a hundred times as long as with the core, so one round suffices.
bool is_timed_once(const SceneRow& row, const RunName& run) {
  return (row.reached == Reached::penetration || row.reached == Reached::gap_and_overlap) &&
         (run.engine == "dart" || run.engine == "mujoco");
}

}  // namespace

double thread_seconds() { return seconds_by(CLOCK_THREAD_CPUTIME_ID); }
double wall_seconds() { return seconds_by(CLOCK_MONOTONIC); }

void register_steps(const std::string& filter) {
  for (const SceneRow& row : scenes()) {
    for (const int count : row.sizes) {
      for (const RunName& run : runs(filter)) {
        if (!fits(row, run, count)) continue;
        const std::string text = run.engine + ":" + run.settings.method;
        std::string options;
        for (const auto& [key, value] : run.settings.options) options += fmt::format(",{}={}", key, value);
        const std::string name = fmt::format("step/{}/{}/{}{}", row.name, count, text, options);
        const Subject subject{&row, count, run, &find_engine(engines(), run.engine),
                              run.settings.options.contains("threads")};
        auto* const timed = benchmark::RegisterBenchmark(
            name.c_str(), [subject, name](benchmark::State& state) { time_or_skip(state, subject, name); });
        timed->UseManualTime()->Unit(benchmark::kMicrosecond);
        if (is_timed_once(row, run)) timed->Repetitions(1);
      }
    }
  }
}

}  // namespace rigor::bench
