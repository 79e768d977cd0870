#include "cases/analysis/divergence/run_pair.h"

#include <fmt/format.h>

#include <cmath>

#include "core/base/error.h"
#include "core/engine/simulation.h"

namespace rigor::inline analysis {

CommonSteps common_steps(const StepSize& a, const StepSize& b, double duration) {
  constexpr double kRounding = 1e-9;  // of a step, as where steps are counted
  for (long n = 1; static_cast<double>(n) * a.seconds <= duration * (1 + kRounding); ++n) {
    const double seconds = static_cast<double>(n) * a.seconds, times = std::round(seconds / b.seconds);
    if (times < 1 || std::abs(seconds / b.seconds - times) > kRounding * times) continue;
    return {n, static_cast<long>(times), seconds, steps_in(duration, seconds)};
  }
  throw InputError(
      fmt::format("--dt: steps of {} s and of {} s never end together within {:g} s", a.text, b.text, duration));
}

MotionTask RunPair::task(Side side, std::shared_ptr<const Scene> scene, long common, long finer) const {
  const DivergingRun& own = run(side);
  const long each = (side == Side::a ? steps_.steps_a : steps_.steps_b) * finer;
  return {&engines_.find(own.name.engine),
          own.name.settings,
          std::move(scene),
          nullptr,
          own.dt.seconds / static_cast<double>(finer),
          common * each,
          each};
}

std::vector<StateSeries> RunPair::motions(const std::vector<MotionTask>& tasks) const {
  return simulate_motions(tasks, engines_, options_.jobs, options_.limit, options_.on_motion);
}

}  // namespace rigor::inline analysis
