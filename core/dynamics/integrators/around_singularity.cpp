#include "core/dynamics/integrators/around_singularity.h"

namespace rigor {
namespace {

// A pivot of S relative to its row, some d²: a thousandth of a radian away. Measured of IFToMM A02 with 40 windows: what
// was passed 8e-6 rad away left 1e-6 m, 5e-5 rad 1e-9 m, and nothing was to be seen of 1e-4 rad and more.
constexpr double kTooNear = 1e-6;
constexpr double kShares[] = {0.38, 0.62, 0.26, 0.74};  // of the step, to the end of its first part

}  // namespace

double AroundSingularity::attempt(MutableBodyColumns state, double t, double dt, double share) {
  joints_.note_only(noted_), joints_.forget_pivots();
  inner_->step(state, t, share * dt);
  solver_warning_ = inner_->solver_warning();
  if (share < 1) {
    inner_->step(state, t + share * dt, (1 - share) * dt);
    if (solver_warning_.empty()) solver_warning_ = inner_->solver_warning();
  }
  return joints_.least_pivot();
}

void AroundSingularity::step(MutableBodyColumns state, double t, double dt) {
  start_ = BodyColumns(state);
  noted_ = joints_.noted();
  double furthest = attempt(state, t, dt, 1);
  if (!(furthest < kTooNear)) return;
  best_ = BodyColumns(state);
  std::string noted = joints_.noted(), warning = solver_warning_;
  for (const double share : kShares) {
    copy_columns(start_.columns(), state);
    const double pivot = attempt(state, t, dt, share);
    if (pivot > furthest)
      furthest = pivot, best_ = BodyColumns(state), noted = joints_.noted(), warning = solver_warning_;
  }
  copy_columns(best_.columns(), state);
  joints_.note_only(noted), solver_warning_ = warning;
}

}  // namespace rigor
