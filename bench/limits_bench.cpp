// What bounds a step from below, measured in the same run: moving the state's memory, and the arithmetic of a step with
// everything in the first-level cache.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstring>

#include "bench/benchmarks.h"
#include "bench/scenes.h"
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
void copy_state(benchmark::State& state, int count) {
  const BodyTable from = state_of(scene_of(scene_row("free-bodies"), count));
  BodyTable to(from);
  const int repeats = std::max(1, 100000 / count);
  double seconds = 0;
  for (auto _ : state) {
    const double start = thread_seconds();
    for (int n = 0; n < repeats; ++n) {
      for (int c = 0; c < kRotation; ++c)
        std::memcpy(to.columns().column(c), from.columns().column(c), from.size() * sizeof(double));
      benchmark::ClobberMemory();
    }
    const double taken = thread_seconds() - start;
    seconds += taken;
    state.SetIterationTime(taken);
  }
  report(state, seconds, static_cast<double>(state.iterations()) * repeats * count);
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
  for (const Integrator& method : integrators()) {
    if (!method.twin_of.empty()) continue;
    benchmark::RegisterBenchmark(fmt::format("limit/in-cache/core:{}", method.name).c_str(), step_in_cache, method.name)
        ->UseManualTime();
  }
}

}  // namespace rigor::bench
