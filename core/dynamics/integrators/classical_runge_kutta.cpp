#include "core/dynamics/integrators/classical_runge_kutta.h"

#include <array>

#include "core/dynamics/joints/joints.h"

namespace rigor::inline dynamics {

namespace {

constexpr std::size_t kClassicalStages = 4;
constexpr std::array<double, kClassicalStages> kWeight = {1.0 / 6, 1.0 / 3, 1.0 / 3, 1.0 / 6};
constexpr std::array<double, kClassicalStages> kNextStage = {0.5, 0.5, 1, 0}, kStageTime = {0, 0.5, 0.5, 1};

}  // namespace

ClassicalRungeKutta::ClassicalRungeKutta(const StepperParts& parts, OrientationChart chart)
    : parts_(parts),
      chart_(chart),
      loads_(parts.system),
      stage_(parts.system.size()),
      sum_(parts.system.size()),
      carried_(kCarriedColumns, parts.system.size()) {}

void ClassicalRungeKutta::step(MutableBodyColumns state, double t, double dt) {
  if (parts_.contact) {
    parts_.system.wrenches(state, t, dt, wrenches_);
    resolve_ahead(*parts_.contact, parts_.system, wrenches_, dt, state);
  }
  parts_.system.loads.for_each_smooth_part(t, dt,
                                           [&](double from, double length) { smooth_part(state, from, length); });
  if (parts_.joints) parts_.joints->project(state);
}

void ClassicalRungeKutta::smooth_part(MutableBodyColumns state, double t, double dt) {
  const BodyConstants& bodies = parts_.system.constants;
  ConstraintForces* const constraints = parts_.constraints();
  if (parts_.system.loads.empty() && !constraints) {
    bodies.for_each_block([&](const Bodies& block) {
      for (std::size_t s = 0; s < kClassicalStages; ++s) take_stage(s, block, state, nullptr, dt);
    });
    return;
  }
  for (std::size_t s = 0; s < kClassicalStages; ++s) {
    const BodyColumns at = s == 0 ? state : stage_.columns();
    const double* wrench = loads_.over_step(at, t, dt, t + kStageTime[s] * dt);
    using Rows = ConstraintForces::Rows;
    if (constraints) wrench = constraints->hold(at, wrench, s == 0 ? Rows::chosen_anew : Rows::as_chosen);
    bodies.for_each_block([&](const Bodies& block) { take_stage(s, block, state, wrench, dt); });
  }
}

void ClassicalRungeKutta::take_stage(std::size_t s, const Bodies& block, MutableBodyColumns state, const double* wrench,
                                     double dt) {
  const auto stage =
      chart_ == OrientationChart::quaternion ? kernels().quaternion_stage : kernels().rotation_vector_stage;
  const StageTables tables = {state.column(0), stage_.columns().column(0), sum_.columns().column(0), carried_.data()};
  const Stage where = s == 0 ? Stage::first : s + 1 == kClassicalStages ? Stage::last : Stage::middle;
  stage(block, tables, wrench, where, dt * kWeight[s], dt * kNextStage[s]);
}

}  // namespace rigor::inline dynamics
