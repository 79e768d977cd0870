// The cost that Rigor adds to an engine: the seam around each step, the process around each cell, a case file's reader,
// and the truth with and without the cache.
#include <benchmark/benchmark.h>
#include <fmt/format.h>
#include <stdlib.h>

#include <filesystem>
#include <fstream>

#include "adapters/engines.h"
#include "bench/benchmarks.h"
#include "bench/raw_engines.h"
#include "bench/scenes.h"
#include "cases/analysis/repeats/recorded_states.h"
#include "cases/case/case_reader.h"
#include "cases/case/suite.h"
#include "cases/cli/vocabulary.h"
#include "cases/truth/truth.h"
#include "core/engine/run_name.h"

namespace rigor::bench {
namespace {

namespace fs = std::filesystem;

int steps_of(int count) { return std::max(20, 20000 / count); }

void report(benchmark::State& state, double seconds, double body_steps, double checksum) {
  state.counters["ns_per_body_step"] = 1e9 * seconds / body_steps;
  state.counters["checksum"] = checksum;
}

// Both step the same scene as often from the same start, so that their checksums show that they did the same.
template <typename MakeWorld, typename Run, typename Checksum>
void time_fresh_worlds(benchmark::State& state, int count, const MakeWorld& make, const Run& run,
                       const Checksum& checksum) {
  double seconds = 0;
  for (auto _ : state) {
    auto world = make();
    const double start = thread_seconds();
    run(*world);
    const double taken = thread_seconds() - start;
    seconds += taken;
    state.SetIterationTime(taken);
  }
  report(state, seconds, static_cast<double>(state.iterations()) * steps_of(count) * count, checksum());
}

void time_raw(benchmark::State& state, std::unique_ptr<RawWorld> (*make)(const Scene&), int count) {
  const SceneRow& row = scene_row("free-bodies");
  const Scene& scene = scene_of(row, count);
  std::vector<double> read;
  const auto sum_of_positions = [&] {
    double sum = 0;
    for (std::size_t i = 0; i < read.size(); i += 13) sum += read[i] + read[i + 1] + read[i + 2];
    return sum;
  };
  time_fresh_worlds(
      state, count, [&] { return make(scene); }, [&](RawWorld& world) { world.run(steps_of(count), row.dt, read); },
      sum_of_positions);
}

void time_seam(benchmark::State& state, const std::string& name, const std::string& method, int count) {
  const SceneRow& row = scene_row("free-bodies");
  const Scene& scene = scene_of(row, count);
  const Engine& engine = find_engine(engines(), name);
  Snapshot snapshot;
  BodyTable last;
  const auto run = [&](World& world) {
    for (int n = steps_of(count); n > 0; --n) {
      world.step(row.dt);
      world.read(snapshot);
      benchmark::DoNotOptimize(snapshot.bodies().column(0));
    }
  };
  const auto sum_of_positions = [&] {
    const auto world = engine.load(scene, {method, {}, Track::matched});
    run(*world);
    double sum = 0;
    for (std::size_t i = 0; i < snapshot.bodies().size(); ++i) sum += snapshot.bodies().position(i).sum();
    return sum;
  };
  time_fresh_worlds(
      state, count,
      [&] {
        return engine.load(scene, {method, {}, Track::matched});
      },
      run, sum_of_positions);
}

// A run alone, with hashes of its states, as `rigor repeat --record` has them, or with the contact forces of each step.
enum class Beside { nothing, hashes, contacts };
void time_beside(benchmark::State& state, const std::string& scene_name, int count, const std::string& run,
                 Beside beside) {
  constexpr long kSteps = 240;
  const SceneRow& row = scene_row(scene_name);
  const Scene& scene = scene_of(row, count);
  const RunName name = parse_run_name(run, infos_of(engines()));
  const Engine& engine = find_engine(engines(), name.engine);
  double seconds = 0, checksum = 0;
  for (auto _ : state) {
    const double start = thread_seconds();
    if (beside == Beside::hashes) {
      checksum = static_cast<double>(hashes_of(recorded(engine, name.settings, scene, row.dt, kSteps)).back());
    } else {
      const auto world = engine.load(scene, name.settings);
      ReportsContacts* const reports = beside == Beside::contacts ? world->capabilities().contacts : nullptr;
      if (beside == Beside::contacts && !reports) return state.SkipWithError("it reports no contact forces");
      if (reports) reports->ask_for_contacts();
      for (long n = 0; n < kSteps; ++n) {
        world->step(row.dt);
        if (reports) checksum = static_cast<double>(reports->contacts().size());
      }
    }
    const double taken = thread_seconds() - start;
    seconds += taken;
    state.SetIterationTime(taken);
  }
  report(state, seconds, static_cast<double>(state.iterations()) * kSteps * count, checksum);
}

// A folder that goes when the program ends.
const fs::path& scratch_folder() {
  struct Folder {
    fs::path path;
    Folder() {
      std::string name = (fs::temp_directory_path() / "rigor-bench-XXXXXX").string();
      path = mkdtemp(name.data());
    }
    ~Folder() {
      std::error_code ignored;
      fs::remove_all(path, ignored);
    }
  };
  static const Folder folder;
  return folder.path;
}

void time_reading(benchmark::State& state, const std::string& id) {
  const std::string file = (fs::path(default_suite_dir()) / (id + ".toml")).string();
  const Vocabulary words = vocabulary_of(infos_of(engines()));
  for (auto _ : state) benchmark::DoNotOptimize(read_case(file, id, words));
}

void time_truth(benchmark::State& state, const std::string& id, bool is_kept) {
  const Case definition = select_cases({id}, default_suite_dir(), vocabulary_of(infos_of(engines()))).front();
  setenv("RIGOR_CACHE_DIR", is_kept ? scratch_folder().c_str() : "", 1);
  if (is_kept) make_truth(definition.truth, definition.scene, definition.duration);
  for (auto _ : state) benchmark::DoNotOptimize(make_truth(definition.truth, definition.scene, definition.duration));
  unsetenv("RIGOR_CACHE_DIR");
}

// A body that flies for a single step in each of so many cells.
fs::path one_step_case(int cells) {
  const fs::path file = scratch_folder() / fmt::format("cells-{}.toml", cells);
  std::ofstream out(file);
  out << "title = \"one step\"\nsource = \"timing\"\n[scene]\ngravity = [0, 0, -9.81]\n[[scene.body]]\nname = \"a\"\n"
         "mass = 1\ninertia = [1, 1, 1]\nposition = [0, 0, 0]\n[run]\nduration = 0.5\ndt = [";
  for (int k = 0; k < cells; ++k) out << (k ? ", " : "") << fmt::format("{}", 0.5 - 1e-4 * k);
  out << "]\n[truth]\nkind = \"none\"\n[[gate]]\nmetric = \"energy_drift\"\nengines = [\"core:rk4\"]\nmax = 1e9\n"
         "because = \"timing\"\n";
  return file;
}

double seconds_of(const std::string& command) {
  const double start = wall_seconds();
  return std::system(command.c_str()) == 0 ? wall_seconds() - start : -1;
}

// Wall time of a whole `rigor gate`, for one cell more.
void time_cells(benchmark::State& state) {
  constexpr int kCells = 65;
  const auto command = [](int cells) {
    return fmt::format("'{}' gate '{}' --engine core:rk4 --jobs 1 --out '{}' > /dev/null 2>&1", RIGOR_PROGRAM,
                       one_step_case(cells).string(), (scratch_folder() / "out").string());
  };
  const std::string many = command(kCells), one = command(1);
  for (auto _ : state) {
    const double longer = seconds_of(many), shorter = seconds_of(one);
    if (longer < 0 || shorter < 0) {
      state.SkipWithError("rigor gate failed");
      return;
    }
    state.SetIterationTime(std::max(0.0, (longer - shorter) / (kCells - 1)));
    state.counters["whole_program_ms"] = 1e3 * shorter;
  }
}

}  // namespace

void register_harness() {
  for (const int count : {1, 100}) {
    const auto add = [&](const std::string& name, auto run) {
      benchmark::RegisterBenchmark(fmt::format("harness/{}/{}", name, count).c_str(), run)->UseManualTime();
    };
    for (const RawEngine& raw : raw_engines()) {
      add("raw/" + raw.name, [&raw, count](benchmark::State& s) { time_raw(s, raw.make, count); });
      add("seam/" + raw.name, [&raw, count](benchmark::State& s) { time_seam(s, raw.name, raw.method, count); });
    }
  }
  for (const char* run : {"core", "ode", "bullet", "mujoco", "dart"}) {
    for (const auto& [scene, count] : {std::pair("chain", 20), std::pair("pile", 20), std::pair("pile", 216)}) {
      for (const auto& [word, beside] :
           {std::pair("plain", Beside::nothing), {"hashed", Beside::hashes}, {"contacts", Beside::contacts}}) {
        const std::string name = fmt::format("harness/{}/{}/{}/{}", word, scene, count, run);
        benchmark::RegisterBenchmark(name.c_str(), time_beside, scene, count, run, beside)->UseManualTime();
      }
    }
  }
  benchmark::RegisterBenchmark("harness/cell", time_cells)->UseManualTime()->Iterations(2);
  for (const char* id : {"springs/body-springs", "contact/collision"})
    benchmark::RegisterBenchmark(fmt::format("harness/read-case/{}", id).c_str(), time_reading, id);
  for (const char* id : {"springs/fixed-spring", "ballistic/projectile"}) {
    benchmark::RegisterBenchmark(fmt::format("harness/truth/{}", id).c_str(), time_truth, id, false);
    benchmark::RegisterBenchmark(fmt::format("harness/truth-kept/{}", id).c_str(), time_truth, id, true);
  }
}

}  // namespace rigor::bench
