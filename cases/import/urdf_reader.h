// URDF (wiki.ros.org/urdf/XML): a tree of links, each placed by its joint. Conventions of the format: z is up, roll
// pitch yaw are about fixed axes, an axis is in the joint's frame, which is the child's.
#pragma once

#include "cases/import/xml.h"

namespace rigor {

LinkModel read_urdf(const XmlFile& file);

}  // namespace rigor
