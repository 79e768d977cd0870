// The free axis of a joint of an SDF file: its limits, damper and spring.
#pragma once

#include <string>

#include "cases/import/xml.h"

namespace rigor {

// `type` as the file has it: a continuous joint has no limits.
void read_sdf_coordinate(const XmlElement& axis, const std::string& type, Joint& joint, LeftOut& left_out);

// For a joint of two axes: names limits and dampers, which a scene's joint does not have.
void leave_out_sdf_coordinate(const XmlElement& axis, LeftOut& left_out);

}  // namespace rigor
