// A scene that begins in a later state of its motion, so that any engine can be loaded there.
#pragma once

#include <optional>
#include <vector>

#include "core/engine/body_table.h"
#include "core/scene/joints/axis_series.h"
#include "core/scene/scene.h"

namespace rigor::inline analysis {

// Follows the coordinates of a scene's joints through a motion, with whole turns of hinges. Each axis of a compound
// joint has its own.
class JointCoordinates {
 public:
  explicit JointCoordinates(const Scene& scene);
  // The next state. Hinges turn by less than half a turn between two states.
  void follow(const std::vector<BodyState>& bodies);
  const std::vector<double>& values() const { return values_; }  // rad, m; 0 for a joint without a coordinate

 private:
  const Scene& scene_;
  std::vector<std::optional<AxisSeries>> series_;  // of the rows that are compound joints
  std::vector<double> values_;
};

// The scene as it stands at `t` [s], where its own clock begins at 0 again. Anchors and axes stay in the body a of each
// joint or in the world, and behind the axes before them in a compound joint; a gap that the joint has there is closed.
// Joint coordinates count from the state, and rests, limits and targets move along. A limit that is overrun lies at the
// state.
Scene rebased(const Scene& scene, const std::vector<BodyState>& bodies, const std::vector<double>& coordinates,
              double t);

}  // namespace rigor::inline analysis
