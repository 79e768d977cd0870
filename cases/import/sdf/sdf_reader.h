// SDF 1.4 to 1.11 (sdformat.org/spec): worlds, models in models, frames. Conventions of the format: z is up where the
// world says nothing else, a pose is x y z roll pitch yaw about fixed axes; up to 1.4 an axis is in the model's frame,
// from 1.5 on in the joint's; a link without <inertial> has 1 kg and 1 kg m².
#pragma once

#include "cases/import/xml.h"

namespace rigor {

LinkModel read_sdf(const XmlFile& file);

}  // namespace rigor
