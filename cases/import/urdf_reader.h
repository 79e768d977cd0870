// Reads URDF (wiki.ros.org/urdf/XML): a tree of links, each placed by its joint. In this format z is up, and roll,
// pitch and yaw turn about fixed axes. An axis is given in the joint's frame, which is the child's.
#pragma once

#include "cases/import/import_options.h"
#include "cases/import/xml.h"

namespace rigor::inline imports {

LinkModel read_urdf(const XmlFile& file, const ImportOptions& options);

}  // namespace rigor::inline imports
