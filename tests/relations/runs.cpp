#include "tests/relations/runs.h"

#include "adapters/engines.h"
#include "cases/truth/truth.h"
#include "core/engine/engine_failure.h"
#include "core/engine/run_name.h"
#include "tests/cases/judged.h"

namespace rigor::test {

MotionSource run_of_truth(const std::string& truth, double duration, int samples) {
  MotionSource run{.name = truth, .step = duration / samples, .steps = samples, .rounding = 0};
  run.supports = [](const Scene&) { return true; };
  run.motion = [truth](const Scene& scene, double step, int steps) {
    const auto made = make_truth(truth, scene, step * steps);
    Motion motion;
    for (int k = 0; k <= steps; ++k) {
      motion.states.push_back(truth_at(*made, k * step, scene.bodies.size()));
      motion.claims.push_back(made->error(k * step));
    }
    motion.end = static_cast<std::size_t>(steps);
    return motion;
  };
  run.is_symmetric = true;
  return run;
}

MotionSource run_of_engine(const std::string& name, double step, int steps, double rounding) {
  const RunName parsed = parse_run_name(name, infos_of(engines()));
  const Engine& engine = engines().find(parsed.engine);
  const EngineInfo& info = engines().info_of(parsed.engine);
  const MethodInfo& method = method_of(info, parsed.settings);
  MotionSource run{.name = name, .step = step, .steps = steps, .rounding = rounding};
  const Settings settings = parsed.settings;
  run.supports = [&info, settings, step](const Scene& scene) {
    return why_unsupported(info, settings, scene, step).empty();
  };
  run.motion = [&engine, settings](const Scene& scene, double dt, int count) {
    const Simulation made =
        simulate(engine, settings, scene, dt, dt * count, {.steps_per_sample = 1, .is_timed = false});
    Motion motion;
    double end = dt * count;
    if (made.reduced_order) end = std::min(end, made.reduced_order->from);
    if (!made.solver_warning.empty()) end = std::min(end, made.solver_warning_time - dt);
    for (const Sample& sample : made.trajectory.samples) {
      motion.states.emplace_back(sample.bodies.columns());
      if (sample.time <= end * (1 + 1e-12)) motion.end = motion.states.size() - 1;
    }
    return motion;
  };
  run.is_symmetric = method.symmetric && !settings.options.contains("contact");
  run.takes_binary_units = info.is_in_house;
  run.is_one_step = method.name.find("adams") == std::string::npos;
  run.has_two_ways = !run.is_one_step;  // a rounding decides in which step a force begins, and with it the history
  if (method.adaptive || !run.is_one_step) run.tolerance = 1e-12;  // the default, also of the steps that start adams
  return run;
}

}  // namespace rigor::test
