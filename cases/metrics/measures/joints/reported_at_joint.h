// What an engine reports of a joint, in the terms of the truth: on b, at the joint's point.
#pragma once

#include "cases/metrics/measures/joints/joint_geometry.h"
#include "cases/metrics/measures/joints/joint_reactions.h"
#include "core/engine/capabilities.h"

namespace rigor::inline metric {

// `bodies`: at the start of the step that the report is about.
JointReaction reported_at_joint(const Joint& joint, const JointGeometry& geometry, const ReportedReaction& reported,
                                BodyColumns bodies);

}  // namespace rigor::inline metric
