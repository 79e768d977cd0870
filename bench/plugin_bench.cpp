// What an engine from outside costs beside its own work, on free bodies. "step" is one
// step and one read, a request each; "run" is a thousand steps in one request, of which each 33rd is sampled. By the
// wall; `ours` is the CPU time of this process alone, for each step. A library is also called without Rigor ("direct").
#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <array>
#include <memory>

#include "adapters/plugin/library_engine.h"
#include "adapters/plugin/plugins.h"
#include "adapters/plugin/shared_library.h"
#include "bench/benchmarks.h"
#include "core/engine/engine.h"
#include "core/scene/toml/writing/scene_writer.h"

namespace rigor::bench {
namespace {

constexpr double kStep = 1e-3;  // s

Scene free_bodies(int count) {
  Scene scene;
  scene.gravity = {0, 0, -9.81};
  for (int i = 0; i < count; ++i) {
    Body body;
    body.name = fmt::format("body {}", i), body.position = {2.0 * i, 0, 0};
    body.inertia = Vec3(1, 2, 2.5).asDiagonal(), body.angular_velocity = {0.3, 0.9, -0.5};
    scene.bodies.push_back(body);
  }
  return scene;
}

std::unique_ptr<World> world_of(const Engine& engine, int count) {
  Settings settings;
  settings.method = engine.info().methods.front().name;
  return engine.load(free_bodies(count), settings);
}

void report_ours(benchmark::State& state, double before, double steps) {
  state.counters["ours_us_per_step"] = 1e6 * (thread_seconds() - before) / steps;
}

void step_and_read(benchmark::State& state, const Engine& engine, int count) {
  const auto world = world_of(engine, count);
  Snapshot now;
  const double before = thread_seconds();
  for (auto _ : state) {
    world->step(kStep), world->read(now);
    benchmark::DoNotOptimize(now.bodies().column(0));
  }
  report_ours(state, before, static_cast<double>(state.iterations()));
}

void run_thousand(benchmark::State& state, const Engine& engine, int count, long every) {
  constexpr long kSteps = 1000;
  const auto world = world_of(engine, count);
  Snapshot now;
  const double before = thread_seconds();
  for (auto _ : state) {
    expect_steps(*world, kStep, kSteps, every);
    for (long n = 1; n <= kSteps; ++n) {
      world->step(kStep);
      if (n % every == 0 || n == kSteps) world->read(now);
    }
  }
  report_ours(state, before, static_cast<double>(state.iterations() * kSteps));
}

// The same calls as the seam's, into separate columns.
void direct(benchmark::State& state, const std::string& path, int count) {
  const rigor_engine_v1& engine = load_library(path);
  std::array<char, 1024> text{};
  const rigor_text room{text.data(), text.size()};
  rigor_world* world = nullptr;
  const std::string scene = scene_json(free_bodies(count));
  if (engine.load(scene.c_str(), R"({"method":"euler","track":"matched","options":{}})", &world, room) != RIGOR_OK)
    return state.SkipWithError("it does not load");
  std::vector<double> data(13 * static_cast<std::size_t>(count));
  std::array<double*, 13> columns{};
  for (int c = 0; c < 13; ++c) columns[c] = data.data() + c * count;
  double time = 0;
  for (auto _ : state) {
    engine.step(world, kStep, nullptr, room), engine.read(world, &time, columns.data(), room);
    benchmark::DoNotOptimize(data.data());
  }
  engine.unload(world, room);
}

}  // namespace

void register_plugins(const std::vector<std::string>& plugins) {
  static EngineTable table;  // benchmarks run later
  for (const std::string& plugin : plugins) add_plugin(table, plugin, 600);
  for (const EngineInfo& info : table.infos()) {
    const Engine& engine = table.find(info.name);
    for (const int count : {1, 100, 1000}) {
      const auto name = [&](const char* what) { return fmt::format("plugin/{}/{}/{}", what, count, info.name); };
      benchmark::RegisterBenchmark(name("step").c_str(), step_and_read, std::cref(engine), count)->UseRealTime();
      if (engine.is_remote()) {
        benchmark::RegisterBenchmark(name("run").c_str(), run_thousand, std::cref(engine), count, 33)->UseRealTime();
        benchmark::RegisterBenchmark(name("run-every-step").c_str(), run_thousand, std::cref(engine), count, 1)
            ->UseRealTime();
      }
    }
  }
  for (const std::string& plugin : plugins) {
    for (const int count : {1, 100, 1000}) {
      if (plugin.ends_with(".so"))
        benchmark::RegisterBenchmark(fmt::format("plugin/direct/{}/{}", count, plugin).c_str(), direct, plugin, count)
            ->UseRealTime();
    }
  }
}

}  // namespace rigor::bench
