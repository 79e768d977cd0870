// Gazebo's additions to URDF.
#pragma once

#include <map>
#include <string>

#include "cases/import/xml.h"
#include "core/scene/link_model.h"

namespace rigor::inline imports {

// Reads a <gazebo> element: the friction of a link and whether gravity acts on it. `links`: their places in the model,
// by name. What else would change the motion is added to model.left_out.
void read_urdf_gazebo(const XmlElement& element, const std::map<std::string, std::size_t>& links, LinkModel& model);

// Where the <pose> of a <gazebo> element without reference puts the whole model.
BodyPose pose_of_urdf_model(const XmlElement& robot, LeftOut& left_out);

}  // namespace rigor::inline imports
