// What a run leaves of a recorded trial, sample by sample.
#pragma once

#include <vector>

#include "cases/case/case.h"
#include "cases/truth/recorded/recorded_motion.h"
#include "core/engine/engine.h"

namespace rigor::inline analysis {

// Gaps in standard deviations of the noise, three components for each sample of each body that moves, in W. Each
// measured sample counts once, so that equal numbers say equally much with every step of the run.
struct TrialResiduals {
  std::vector<double> positions, rotations;
  bool has_result = false;
};

// The run is read between its own samples, from Hermite's cubic. The trial's first sample counts, too.
TrialResiduals trial_residuals(const Case& of_trial, const RecordedMotion& truth, const Engine& engine,
                               const Settings& settings, double dt);

// A move of a body's start, in W.
struct StartShift {
  Vec3 position = Vec3::Zero(), turn = Vec3::Zero();              // m; rad, a rotation vector
  Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();  // m/s, rad/s
};
void move_start(Body& body, const StartShift& shift);

}  // namespace rigor::inline analysis
