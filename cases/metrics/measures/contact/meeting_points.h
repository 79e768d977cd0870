// The points at which bodies may press on each other within a step of the truth.
#pragma once

#include <vector>

#include "cases/metrics/measures/contact/pair_forces.h"
#include "core/scene/contact_laws.h"

namespace rigor::inline metric {

struct MeetingPoint {
  BodyPair pair;
  Vec3 point;  // m, in W, at the middle of the step
  Vec3 normal;
  bool has_friction;
  // Whether the pair may also exchange a couple here: its law resists turning, or one point stands for an area or a
  // line whose points are not known.
  bool has_couple;
};

// The points of all pairs that touch at the start or the end of a step, or may meet between. Two bodies may meet if
// their surfaces approach by at least the gap, as the velocities at both ends and impacts between them allow. Points
// that are apart while others of the pair touch count up to a thousandth of the smallest body's size. More points
// determine fewer forces.
std::vector<MeetingPoint> meeting_points(const Scene& scene, const ContactLaws& laws, BodyColumns before,
                                         BodyColumns after, double dt);

}  // namespace rigor::inline metric
