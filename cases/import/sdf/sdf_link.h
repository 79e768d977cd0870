// A link of an SDF file: its inertia and its shapes, in its own frame.
#pragma once

#include "cases/import/xml.h"

namespace rigor::inline imports {

// A <pose>: x y z roll pitch yaw, or as its attributes say. The caller resolves relative_to.
BodyPose sdf_pose(const std::optional<XmlElement>& pose, LeftOut& left_out);

// Poses are in the link's frame, as is a plane's. `file`: for paths of meshes. `repairs`: inertias that no body can
// have.
Link read_sdf_link(const XmlElement& element, const std::string& file, bool repairs, LeftOut& left_out);

}  // namespace rigor::inline imports
