// The free axis of a joint of an SDF file: its limits, damper, friction and spring.
#pragma once

#include <string>

#include "cases/import/xml.h"

namespace rigor::inline imports {

// `type` as the file has it: a continuous joint has no limits. A joint whose limits are both zero becomes a fixed one.
void read_sdf_coordinate(const XmlElement& axis, const std::string& type, LinkJoint& row, LeftOut& left_out);

}  // namespace rigor::inline imports
