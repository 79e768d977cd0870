#include "core/dynamics/integrators/classical_runge_kutta.h"

#include <array>

namespace rigor {

ClassicalRungeKutta::ClassicalRungeKutta(const StepperParts& parts, OrientationChart chart)
    : parts_(parts), equations_(parts.system, chart), rates_(equations_.dimension()) {}

void ClassicalRungeKutta::step(MutableBodyColumns state, double t, double dt) {
  if (parts_.contact) {
    parts_.system.wrenches(state, t, dt, wrenches_);
    resolve_ahead(*parts_.contact, parts_.system, wrenches_, dt, state);
  }
  parts_.system.loads.for_each_smooth_part(t, dt,
                                           [&](double from, double length) { smooth_part(state, from, length); });
}

void ClassicalRungeKutta::smooth_part(MutableBodyColumns state, double t, double dt) {
  constexpr std::array<double, 4> kWeight = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
  constexpr std::array<double, 4> kNextStage = {0.5, 0.5, 1, 0};
  equations_.begin(state, start_);
  sum_ = stage_ = start_;
  for (std::size_t s = 0; s < kWeight.size(); ++s) {
    equations_.rates(stage_, t, dt, rates_);
    sum_ += dt * kWeight[s] * rates_;
    stage_ = start_ + dt * kNextStage[s] * rates_;
  }
  equations_.write(sum_, state);
}

}  // namespace rigor
