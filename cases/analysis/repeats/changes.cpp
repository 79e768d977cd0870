#include "cases/analysis/repeats/changes.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "cases/analysis/divergence/parting_bounds.h"
#include "cases/analysis/repeats/reordered_scene.h"
#include "core/dynamics/kernels/kernels.h"

namespace rigor::inline analysis {
namespace {

RecordedStates run_again(const RepeatedRun& run, const Settings& settings) {
  return recorded(run.engine, settings, run.scene, run.dt, run.steps);
}

// A scene that the engine takes as it takes this one, and whose motion differs.
Scene other_scene(const Scene& scene) {
  Scene other = scene;
  other.gravity += Vec3(0.3, -0.2, 0.5);
  return other;
}
constexpr double kOtherStep = 0.75;  // of the run's step
constexpr long kOtherSteps = 200;

std::vector<ChangedRun> loaded_again(const RepeatedRun& run, std::string&) {
  return {{"", [run] {
             run_again(run, run.name.settings);
             return run_again(run, run.name.settings);
           }}};
}

std::vector<ChangedRun> after_another(const RepeatedRun& run, std::string&) {
  return {{"", [run] {
             const long steps = std::min(run.steps, kOtherSteps);
             recorded(run.engine, run.name.settings, other_scene(run.scene), kOtherStep * run.dt, steps);
             return run_again(run, run.name.settings);
           }}};
}

std::vector<ChangedRun> beside_another(const RepeatedRun& run, std::string&) {
  return {{"", [run] {
             const auto world = run.engine.load(run.scene, run.name.settings),
                        other = run.engine.load(other_scene(run.scene), run.name.settings);
             expect_steps(*world, run.dt, run.steps, 1), expect_steps(*other, run.dt, run.steps, 1);
             RecordedStates states, unused;
             states.add(*world);
             for (long n = 0; n < run.steps; ++n) {
               world->step(run.dt), states.add(*world);
               other->step(run.dt), unused.values.clear(), unused.add(*other);
             }
             return states;
           }}};
}

// A part of the run, a world that is saved there and runs on, and the rest of the run from what was saved, in that
// world or in a fresh one.
RecordedStates restored_after(const RepeatedRun& run, long saved_after, bool in_fresh_world) {
  const auto world = run.engine.load(run.scene, run.name.settings);
  RecordedStates states;
  states.add(*world);
  for (long n = 0; n < saved_after; ++n) world->step(run.dt), states.add(*world);
  const auto saved = world->capabilities().state->save();
  for (long n = saved_after; n < run.steps; ++n) world->step(run.dt);
  const auto fresh = in_fresh_world ? run.engine.load(run.scene, run.name.settings) : nullptr;
  World& next = fresh ? *fresh : *world;
  next.capabilities().state->restore(*saved);
  for (long n = saved_after; n < run.steps; ++n) next.step(run.dt), states.add(next);
  return states;
}

std::vector<ChangedRun> restored(const RepeatedRun& run, std::string& why_not) {
  if (!run.saves_state) {
    why_not = "the engine saves no state of this scene";
    return {};
  }
  // What a snapshot lacks may matter at one instant alone, as in the middle of an impact.
  std::vector<ChangedRun> runs = {{"same world", [run] { return restored_after(run, run.steps / 2, false); }}};
  for (const long eighths : {1, 2, 3, 4, 5, 6, 7}) {
    const long saved_after = run.steps * eighths / 8;
    if (saved_after == run.steps * (eighths - 1) / 8) continue;  // of a run of few steps
    runs.push_back(
        {fmt::format("after {}", saved_after), [run, saved_after] { return restored_after(run, saved_after, true); }});
  }
  return runs;
}

std::vector<ChangedRun> with_threads(const RepeatedRun& run, std::string& why_not) {
  const auto& options = method_of(run.info, run.name.settings).options;
  const bool has = std::any_of(options.begin(), options.end(), [](const OptionInfo& o) { return o.name == "threads"; });
  why_not = has ? "" : "the method has no option 'threads'";
  std::vector<ChangedRun> runs;
  for (const char* count : {"1", "2", "4"}) {
    if (!has) break;
    Settings settings = run.name.settings;
    settings.options["threads"] = count;
    runs.push_back({std::string("threads ") + count, [run, settings] { return run_again(run, settings); }});
  }
  return runs;
}

std::vector<ChangedRun> with_lanes(const RepeatedRun& run, std::string& why_not) {
  std::vector<ChangedRun> runs;
  if (!run.info.is_in_house) {
    why_not = "the core alone has kernels to choose from";
    return runs;
  }
  const Kernels* tables[kMostKernelTables];
  const std::size_t count = available_kernels(tables);
  for (std::size_t n = 0; n < count; ++n) {
    const Kernels* table = tables[n];
    runs.push_back({table->name, [run, table] {
                      const KernelsInPlace in_place(*table);
                      return run_again(run, run.name.settings);
                    }});
  }
  if (count < kMostKernelTables)
    runs.push_back(
        {"others", {}, {}, fmt::format("this processor has {} of {} instruction sets", count, kMostKernelTables)});
  return runs;
}

std::vector<ChangedRun> in_another_order(const RepeatedRun& run, std::string& why_not) {
  const Scene& scene = run.scene;
  const std::size_t most =
      std::max({scene.bodies.size(), scene.joints.size(), scene.couplings.size(), scene.springs.size(),
                scene.motors.size(), scene.contact_pairs.size(), scene.forces.size()});
  std::vector<ChangedRun> runs;
  if (most < 2) {
    why_not = "the scene has no two rows of a kind";
    return runs;
  }
  for (const std::uint64_t seed : {1, 2, 3}) {
    runs.push_back(
        {fmt::format("seed {}", seed), [run, seed] {
           const ReorderedScene other = reordered(run.scene, seed);
           return recorded(run.engine, run.name.settings, other.scene, run.dt, run.steps).ordered(other.places);
         }});
  }
  return runs;
}

// m: no copy comes near another within the steps, also if its bodies move apart.
double spacing_of(const RepeatedRun& run) {
  double fastest = 0;
  for (const Body& body : run.scene.bodies) fastest = std::max(fastest, body.velocity.norm());
  const double seconds = run.dt * static_cast<double>(run.steps);
  const double reach = fastest * seconds + 0.5 * run.scene.gravity.norm() * seconds * seconds;
  // A power of two, so that positions of copies round as little as they can.
  return std::exp2(std::ceil(std::log2(8 * scene_size(run.scene) + 4 * reach + 1)));
}

std::vector<ChangedRun> in_copies(const RepeatedRun& run, std::string& why_not) {
  constexpr std::size_t kCopies = 64, kMostBodies = 2000;
  constexpr long kMostSteps = 100;  // 64 times as much work each
  std::vector<ChangedRun> runs;
  const auto direction = free_direction(run.scene);
  if (!direction) why_not = "planes on all sides leave no room for copies";
  if (run.scene.bodies.size() * kCopies > kMostBodies)
    why_not = fmt::format("64 copies have more than {} bodies", kMostBodies);
  if (!why_not.empty()) return runs;
  RepeatedRun short_run = run;
  short_run.steps = std::min(run.steps, kMostSteps);
  const Vec3 offset = spacing_of(short_run) * *direction;
  const auto all = std::make_shared<std::optional<RecordedStates>>();
  const auto scene = std::make_shared<const CopiedScene>(copied(run.scene, kCopies, offset));
  for (const std::size_t k : {std::size_t{0}, kCopies / 3, kCopies - 1}) {
    runs.push_back({fmt::format("copy {}", k + 1),
                    [short_run, scene, all, k] {
                      if (!*all)
                        *all = recorded(short_run.engine, short_run.name.settings, scene->scene, short_run.dt,
                                        short_run.steps);
                      return (*all)->ordered(scene->places[k]);
                    },
                    [short_run, offset, k] {
                      const Scene alone = moved_scene(short_run.scene, static_cast<double>(k) * offset);
                      return recorded(short_run.engine, short_run.name.settings, alone, short_run.dt, short_run.steps);
                    }});
  }
  return runs;
}

}  // namespace

const std::vector<RepeatChange>& repeat_changes() {
  static const std::vector<RepeatChange> table = {
      {"again", "the same scene, loaded again", true, loaded_again},
      {"after-another", "after another scene ran in the process", true, after_another},
      {"beside-another", "in turns with a second world in the process", true, beside_another},
      {"restored", "saved on the way, and restored in this world or a fresh one", true, restored},
      {"threads", "with 1, 2 and 4 threads", true, with_threads},
      {"lanes", "with the kernels of each instruction set", true, with_lanes},
      {"order", "with rows in another order, three times", false, in_another_order},
      {"copies", "beside 63 copies in one world", false, in_copies, true},
  };
  return table;
}

}  // namespace rigor::inline analysis
