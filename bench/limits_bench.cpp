// Lower bounds of a step, measured in the same run: moving the state's memory, and the arithmetic of a step with all
// data in the first-level cache.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "bench/benchmarks.h"
#include "bench/scenes.h"
#include "core/base/thread_pool.h"
#include "core/dynamics/integrators/integrator.h"

namespace rigor::bench {
namespace {

BodyTable state_of(const Scene& scene) {
  BodyTable table(scene.bodies.size());
  set_initial_state(scene, table.columns());
  return table;
}

void report(benchmark::State& state, double seconds, double body_steps) {
  state.counters["ns_per_body_step"] = 1e9 * seconds / body_steps;
}

// Thirteen doubles a body from one place to another, once a step.
void copy_rows(const BodyTable& from, BodyTable& to, std::size_t first, std::size_t last) {
  for (int c = 0; c < kRotation; ++c) {
    const double* const source = from.columns().column(c);
    std::copy(source + first, source + last, to.columns().column(c) + first);
  }
  benchmark::ClobberMemory();
}

void copy_state(benchmark::State& state, int count) {
  const BodyTable from = state_of(scene_of(scene_row("free-bodies"), count));
  BodyTable to(from);
  const int repeats = std::max(1, 100000 / count);
  double seconds = 0;
  for (auto _ : state) {
    const double start = thread_seconds();
    for (int n = 0; n < repeats; ++n) copy_rows(from, to, 0, from.size());
    const double taken = thread_seconds() - start;
    seconds += taken;
    state.SetIterationTime(taken);
  }
  report(state, seconds, static_cast<double>(state.iterations()) * repeats * count);
}

// The same with several threads, each with its share; in wall time, the fastest of the copies.
void copy_state_by_threads(benchmark::State& state, int count, int threads) {
  constexpr int kRepeats = 10;
  const BodyTable from = state_of(scene_of(scene_row("free-bodies"), count));
  BodyTable to(from);
  ThreadPool thread_pool(threads);
  const std::size_t share = (from.size() + thread_pool.members() - 1) / thread_pool.members();
  const auto copy = [&](std::size_t member) {
    copy_rows(from, to, member * share, std::min((member + 1) * share, from.size()));
  };
  double least = std::numeric_limits<double>::infinity();
  for (auto _ : state) {
    double seconds = 0;
    for (int n = 0; n < kRepeats; ++n) {
      const double start = wall_seconds();
      thread_pool.run(copy);
      const double taken = wall_seconds() - start;
      seconds += taken;
      least = std::min(least, taken);
    }
    state.SetIterationTime(seconds);
  }
  report(state, least, count);
}

// A method without its world, on so few bodies that hardly any memory beyond the first-level cache is touched.
void step_in_cache(benchmark::State& state, const std::string& method) {
  constexpr int kBodies = 256, kRepeats = 500;
  const SceneRow& row = scene_row("free-bodies");
  const System system(scene_of(row, kBodies));
  BodyTable table = state_of(scene_of(row, kBodies));
  const auto stepper = integrator(method).make({system, nullptr, &orientation_update("quaternion-exponential")});
  double seconds = 0;
  for (auto _ : state) {
    const double start = thread_seconds();
    for (int n = 0; n < kRepeats; ++n) stepper->step(table.columns(), 0, row.dt);
    const double taken = thread_seconds() - start;
    seconds += taken;
    state.SetIterationTime(taken);
  }
  report(state, seconds, static_cast<double>(state.iterations()) * kRepeats * kBodies);
}

}  // namespace

void register_limits() {
  for (const int count : scene_row("free-bodies").sizes) {
    benchmark::RegisterBenchmark(fmt::format("limit/copy/{}", count).c_str(), copy_state, count)->UseManualTime();
  }
  for (const int threads : {1, 2}) {
    benchmark::RegisterBenchmark(fmt::format("limit/copy/100000,threads={}", threads).c_str(), copy_state_by_threads,
                                 100000, threads)
        ->UseManualTime();
  }
  for (const Integrator& method : integrators()) {
    benchmark::RegisterBenchmark(fmt::format("limit/in-cache/core:{}", method.name).c_str(), step_in_cache, method.name)
        ->UseManualTime();
  }
}

}  // namespace rigor::bench
