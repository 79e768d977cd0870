// Joints with an axis each, from one body to the next without a body with mass between them: one joint of a scene.
#pragma once

#include <vector>

#include "core/scene/link_model.h"

namespace rigor::inline imports {

struct JointSeries {
  std::vector<Joint> rows;  // of Scene::joints, one behind the other; empty if no joint of a scene equals the series
  std::vector<int> place;   // by joint of the series: the row with its coordinate, or -1
};

// `chain`: from a to b, at their starts. Two hinges through a point at right angles with nothing on their axes become a
// universal joint.
JointSeries joints_in_series(const std::vector<const LinkJoint*>& chain, int a, int b);

}  // namespace rigor::inline imports
