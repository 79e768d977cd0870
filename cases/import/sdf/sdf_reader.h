// Reads SDF 1.4 to 1.11 (sdformat.org/spec): worlds, models in models, frames. By default z is up. A pose is x y z roll
// pitch yaw about fixed axes. An axis is in the model's frame up to 1.4, and in the joint's from 1.5 on. A link without
// <inertial> has 1 kg and 1 kg m².
#pragma once

#include "cases/import/import_options.h"
#include "cases/import/xml.h"

namespace rigor::inline imports {

LinkModel read_sdf(const XmlFile& file, const ImportOptions& options);

}  // namespace rigor::inline imports
