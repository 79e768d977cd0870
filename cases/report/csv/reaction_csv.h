// Joint loads as CSV: one row per joint and instant. The force and the couple act on b at the joint's point, and the
// couple is about that point; a carries the opposite. All in W. Numbers have 17 significant digits.
#pragma once

#include <string>

#include "cases/metrics/measures/joints/joint_reactions.h"

namespace rigor::inline report {

inline constexpr const char* kReactionHeader = "time,joint,px,py,pz,fx,fy,fz,tx,ty,tz\n";

// `point` [m]: b's end of the joint. A joint without a name is called by its two bodies: "a and b".
void append_reaction_row(std::string& out, const Scene& scene, const Joint& joint, double time, const Vec3& point,
                         const JointReaction& reaction);

}  // namespace rigor::inline report
