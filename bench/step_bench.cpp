// Step throughput of every engine and method on every scene of scenes.cpp, for 1 to 10,000 bodies. Absolute times
// depend on the machine; compare rows of one run. The checksum of the final positions shows that the work was done.
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include "adapters/engines.h"
#include "bench/scenes.h"

using namespace rigor;

namespace {

constexpr double kStep = 1.0 / 240;  // s
// After so many steps a world starts afresh, so that what is timed is always the same stretch of motion: neither at
// rest nor blown up.
constexpr int kStepsOfOneRun = 1000;

// Of the positions after a fixed number of steps, however many the timing took.
double checksum(const Engine& engine, const Settings& settings, const Scene& scene) {
  const auto world = engine.load(scene, settings);
  for (int n = 0; n < 100; ++n) world->step(kStep);
  Snapshot snapshot;
  world->read(snapshot);
  double sum = 0;
  for (std::size_t i = 0; i < snapshot.bodies().size(); ++i) sum += snapshot.bodies().position(i).sum();
  return sum;
}

// A body-step includes reading the state back, which is what a user of an engine does after each step.
void time_steps(benchmark::State& state, const Engine& engine, const Settings& settings, const bench::SceneRow& row,
                int count) {
  const Scene scene = row.make(count);
  const std::string obstacle = why_unsupported(engine.info(), settings, scene, kStep);
  if (!obstacle.empty()) {
    state.SkipWithError(obstacle.c_str());
    return;
  }
  auto world = engine.load(scene, settings);
  Snapshot snapshot;
  int steps = 0;
  for (auto _ : state) {
    if (++steps > kStepsOfOneRun) {
      state.PauseTiming();
      world = engine.load(scene, settings);
      steps = 1;
      state.ResumeTiming();
    }
    world->step(kStep);
    world->read(snapshot);
    benchmark::DoNotOptimize(snapshot.bodies().column(0));
  }
  const auto body_steps = static_cast<double>(state.iterations()) * count;
  state.counters["body_steps"] = benchmark::Counter(body_steps, benchmark::Counter::kIsRate);
  state.counters["body_step"] =
      benchmark::Counter(body_steps, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["checksum"] = checksum(engine, settings, scene);
}

void register_steps() {
  for (const bench::SceneRow& row : bench::scenes()) {
    for (const int count : {1, 100, 1000, 10000}) {
      for (const auto& engine : engines()) {
        for (const MethodInfo& method : engine->info().methods) {
          if (!method.twin_of.empty()) continue;  // an instrument, whose speed is of no interest
          const std::string name = fmt::format("{}/{}/{}:{}", row.name, count, engine->info().name, method.name);
          benchmark::RegisterBenchmark(name.c_str(), time_steps, std::cref(*engine),
                                       Settings{method.name, {}, Track::matched}, row, count)
              ->Unit(benchmark::kMicrosecond);
        }
      }
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  register_steps();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
