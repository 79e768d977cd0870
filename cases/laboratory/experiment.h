// One run of the laboratory: a world behind the engines' seam that is stepped, and what is measured of it after each
// step.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "adapters/engines.h"
#include "cases/laboratory/true_motion.h"
#include "cases/metrics/measures/joints/joint_geometry.h"
#include "cases/results/results.h"
#include "core/engine/engine.h"
#include "core/engine/trajectory.h"

namespace rigor::inline laboratory {

// After a step. Not a number: not known (no truth yet), or not finite.
struct LiveReading {
  double time = 0;               // s
  double energy = 0;             // J
  double orthonormality = 0;     // |RᵀR - I| by Frobenius, the largest of all bodies
  double position_error = 0;     // m, the largest of all bodies, to the truth
  double orientation_error = 0;  // rad
  double joint_gap = 0;          // m, the widest of all joints; not a number where there are none
};

class Experiment {
 public:
  // Throws InputError for a run that is not in the table of engines, and with the reason where it does not take the
  // scene.
  Experiment(const EngineTable& engines, Scene scene, const std::string& run, double dt, double duration);

  // False at the end of the duration, after a state that is not finite, and after a step that fails; see why_ended().
  bool step();
  // Sets the truth, for errors from t = 0 on. Its dt must be the run's. Without rows there are no errors.
  void compare_with(TruthTable truth);

  double time() const { return now_.time; }
  BodyColumns bodies() const { return now_.bodies(); }
  std::size_t readings() const { return readings_.size(); }
  const LiveReading& reading(std::size_t step) const { return readings_[step]; }
  const std::string& why_ended() const { return why_ended_; }  // empty while it runs
  const std::string& run() const { return name_; }             // written out
  const Scene& scene() const { return scene_; }
  SettingsInForce settings() const { return world_->settings_in_force(); }
  // The run so far, judged like a cell of the report: verdict, metrics and settings in force. While it goes on, a brief
  // judgement leaves out what takes seconds: the overlaps of many bodies.
  Cell judge(bool brief = false) const;

 private:
  LiveReading read_now() const;
  void note_error(std::size_t step, BodyColumns bodies, LiveReading& reading) const;
  void record();

  Scene scene_;
  std::vector<JointGeometry> joints_;
  std::string name_;
  double dt_, duration_, stagger_;
  long steps_, every_;  // of the whole run; between two samples that are kept
  std::unique_ptr<World> world_;
  Snapshot now_;
  std::vector<LiveReading> readings_;
  Trajectory kept_;
  std::optional<NotFinite> not_finite_;
  TruthTable truth_;
  std::string why_ended_;
};

}  // namespace rigor::inline laboratory
