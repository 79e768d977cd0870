// How many ways a mechanism in a plane has to move, counted by the rank of what its hinges and sliders forbid.
#pragma once

#include <vector>

#include "cases/truth/closed_form/closed_form.h"
#include "core/scene/scene.h"

namespace rigor::inline truth {

struct PlanePose {
  ExtendedVec3 position = ExtendedVec3::Zero();  // m, in W
  Extended angle = 0;                            // rad, turned about the plane's normal since t = 0
};

// The remaining degrees of freedom of the movable bodies, three each, at these poses, one per body, in the plane across
// the unit `axis`. Only hinges along the axis and sliders across it count.
int plane_freedoms(const Scene& scene, const ExtendedVec3& axis, const std::vector<PlanePose>& poses);

}  // namespace rigor::inline truth
