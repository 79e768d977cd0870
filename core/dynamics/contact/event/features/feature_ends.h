// The ends of features: an edge ends at its corners, a side at its edges, a flat region of triangles at its border,
// a rim where it turns over.
#pragma once

#include "core/dynamics/contact/event/features/contact_kinematics.h"

namespace rigor::inline dynamics {

// m: how far the contact can move before it passes to another feature of a body; negative beyond that, infinite if the
// features do not end.
double distance_from_ends(const FeaturePair& features, const ContactKinematics& kinematics, const Collider& a,
                          const Pose& pose_a, const Collider& b, const Pose& pose_b);

}  // namespace rigor::inline dynamics
